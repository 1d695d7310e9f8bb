// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <complex>
#include <cstdint>
#include <memory>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::solver {

using Complex = std::complex<double>;

/// Sign of the exponent: forward is exp(-2 pi i u x / n). Neither is scaled: there and back multiplies by n.
enum class Direction { forward, inverse };

/// \param n least length
/// \return least even length of at least n whose prime factors are 2, 3 and 5: transforms of such a length are quick.
std::int64_t good_size(std::int64_t n);

/// The discrete Fourier transform of rows of one length, prepared once. One object serves one thread; copies are cheap
/// beside a few transforms.
class LineTransform {
public:
    /// \pre length [1, 2^30], quick when its prime factors are small.
    /// \param length [1, 2^30] number of values
    /// \param direction a direction
    LineTransform(std::int64_t length, Direction direction);
    LineTransform(LineTransform const& other);
    LineTransform(LineTransform&& other) noexcept;
    LineTransform& operator=(LineTransform const&) = delete;
    LineTransform& operator=(LineTransform&&) = delete;
    ~LineTransform();

    /// \pre in and out of the transform's length; they do not overlap.
    /// \param in the values to transform
    /// \param out receives the numbers
    void operator()(Complex const* in, Complex* out);

private:
    struct Plan;
    std::unique_ptr<Plan> plan_;
};

/// The discrete Fourier transform of a field along both axes.
/// \pre a field of any size.
/// \param values the values
/// \param direction a direction
/// \param run progress, log, stop token and number of threads
/// \return sum over x, y of values(x, y) exp(-+2 pi i (u x / width + v y / height)) in column u, row v; the same bits
/// for any number of threads.
/// \throws Cancelled
///
/// Source: kissfft (Borgerding 2003) as packaged with Eigen.
Raster<Complex> fft(Raster<Complex> values, Direction direction, Run const& run = {});

} // namespace thalweg::solver
