// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \cpponly

#include <complex>
#include <cstdint>
#include <memory>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

// Idea: The discrete Fourier transform of a length with small factors splits into transforms of its
// parts (radix 2, 3, 4, 5). In two dimensions all rows are transformed, then all columns, some of
// which are gathered at a time so that cache lines are used whole. kissfft does the butterflies;
// its roots of unity are ours, since libm's differ in their last bits between machines.
// Source: kissfft (Borgerding 2003), as packaged with Eigen.
// Cost: O(n log n) for lengths of factors 2, 3 and 5 (good_size), O(n p) for a large prime factor
// p. Rows and bundles of columns run on all cores.
// Not for: real fields where halving counts (circulant.hpp packs two rows into one); results are
// not scaled: forward and inverse multiply by n.
// Example:
//     Raster<Complex> const spectrum = fft(Raster<Complex>(grid), Direction::forward);
//     std::int64_t const length = good_size(1000); // 1000

namespace thalweg::solver {

using Complex = std::complex<double>;

/// Sign of the exponent: forward is exp(-2 pi i u x / n). Neither is scaled: forward and inverse multiply by n.
enum class Direction { forward, inverse };

/// Finds a length for fast transforms.
/// \param n minimum length
/// \return the least even length >= n whose prime factors are 2, 3 and 5
std::int64_t good_size(std::int64_t n);

/// A prepared discrete Fourier transform of rows of one length. Use one object per thread; copies are cheap.
class LineTransform {
public:
    /// Prepares a transform, fast if the length has small prime factors.
    /// \param length [1, 2^30] number of values
    /// \param direction sign of the exponent
    LineTransform(std::int64_t length, Direction direction);
    LineTransform(LineTransform const& other);
    LineTransform(LineTransform&& other) noexcept;
    LineTransform& operator=(LineTransform const&) = delete;
    LineTransform& operator=(LineTransform&&) = delete;
    ~LineTransform();

    /// Transforms one row.
    /// \param in `length` values
    /// \param out receives `length` values; does not overlap `in`
    void operator()(Complex const* in, Complex* out);

private:
    struct Plan;
    std::unique_ptr<Plan> plan_;
};

/// Computes the discrete Fourier transform of a field along both axes.
/// \param values of any size
/// \param direction sign of the exponent
/// \return in column u, row v: the sum over x, y of values(x, y) exp(-+2 pi i (u x / width + v y / height)); the same
/// bits for any number of threads
///
/// Source: kissfft (Borgerding 2003) as packaged with Eigen.
Raster<Complex> fft(Raster<Complex> values, Direction direction, Run const& run = {});

} // namespace thalweg::solver
