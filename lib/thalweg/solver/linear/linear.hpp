// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \cpponly

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <thalweg/core/run/run.hpp>

// Idea: Small dense problems and large sparse ones. least_squares is QR with column pivoting, which
// also tells the rank; where columns depend on each other a tiny ridge picks a short answer.
// least_squares_on_sphere has a quadratic condition: the unconstrained unknowns are eliminated, and
// the rest becomes a search for one number lambda at which sum (h_i / (w_i + lambda))^2 = tau^2,
// which has one solution beyond the largest pole, the global minimum. factor is a Cholesky factor
// whose sums have one order on any thread and machine; SparseFactor is one of a sparse matrix, made
// once for many right-hand sides.
// Source: Golub and von Matt 1991 (quadratic condition); Eigen for QR, eigenvalues and sparse LDL'.
// Cost: QR O(m n^2); factor O(n^3), its rows on all cores; docs/performance.md: on 2048 x 2048 the
// grid's own solver takes 0.06 of SimplicialLDLT.
// Not for: Poisson's equation on rasters (grid/poisson.hpp); matrices that are not positive
// definite. More than some thousand unknowns are too many for dense factors (n^2 doubles).
// Example:
//     Matrix a(3, 2);
//     a.at(0, 0) = a.at(1, 0) = a.at(2, 0) = 1.0; // a constant, and a slope
//     a.at(1, 1) = 1.0;
//     a.at(2, 1) = 2.0;
//     Solution const line = least_squares(a, {1.0, 2.9, 5.1});

namespace thalweg::solver {

/// A dense matrix in column order.
struct Matrix {
    Matrix() = default;
    Matrix(std::size_t row_count, std::size_t column_count)
        : rows(row_count), columns(column_count), values(row_count * column_count, 0.0) {}

    double& at(std::size_t row, std::size_t column) { return values[column * rows + row]; }
    double at(std::size_t row, std::size_t column) const { return values[column * rows + row]; }

    std::size_t rows = 0;
    std::size_t columns = 0;
    std::vector<double> values;
};

/// The solution of a least-squares problem.
struct Solution {
    std::vector<double> x;
    std::size_t rank = 0; ///< of the matrix; below its number of columns x is from a ridge regression
    double rms = 0.0;     ///< root mean square residual
};

/// Minimises |A x - b| by QR with column pivoting.
/// \param a at least one column
/// \param b as many numbers as A has rows
/// \return with full rank the unique minimum; otherwise that of |A x - b|^2 + ridge |x|^2, ridge 1e-10 of the largest
/// squared column norm
/// \throws BadInput when sizes do not match or a number is not finite
Solution least_squares(Matrix const& a, std::vector<double> const& b);

/// A quadratic constraint on some of the unknowns: y' Q y = tau^2.
struct Sphere {
    std::vector<std::size_t> unknowns; ///< columns that form y, each once
    Matrix form;                       ///< Q: symmetric, positive definite
    double tau = 0.0;                  ///< > 0
};

/// Minimises |A x - b| under a quadratic constraint: the global minimum, by the secular equation sum (h_i / (w_i +
/// lambda))^2 = tau^2 with lambda > -w_min; in the hard case (b has no part along the weakest direction) the missing
/// length is added along it.
/// \param a at least one column
/// \param b as many numbers as A has rows
/// \param sphere the constraint
/// \return |y' Q y - tau^2| <= 1e-10 tau^2
/// \throws BadParameter when tau is not above 0 or Q is not positive definite
/// \throws BadInput as least_squares, and when the columns outside y are rank-deficient
///
/// Source: \cite golub1991 (quadratically constrained least squares).
Solution least_squares_on_sphere(Matrix const& a, std::vector<double> const& b, Sphere const& sphere);

/// The lower triangle L of a symmetric, positive definite matrix L L', in row order.
struct Cholesky {
    std::size_t size = 0;
    std::vector<double> lower;
};

/// Factors a matrix by Cholesky in O(size^3).
/// \param matrix symmetric, size x size numbers; only the lower triangle is read
/// \param size number of rows
/// \param ridge added to the diagonal, relative to its largest number
/// \return the same bits for any number of threads
/// \throws NotConverged when the matrix is not positive definite
Cholesky factor(std::vector<double> matrix, std::size_t size, double ridge, Run const& run = {});

/// Solves a factored system.
/// \param matrix the factor L
/// \param b right-hand side
/// \return x with L L' x = b
std::vector<double> solve(Cholesky const& matrix, std::vector<double> b);

/// An entry of a sparse matrix.
struct SparseEntry {
    std::uint32_t row = 0;
    std::uint32_t column = 0;
    double value = 0.0;
};

/// The factor of a sparse, symmetric, positive definite matrix, for any number of right-hand sides.
class SparseFactor {
public:
    /// Factors a matrix.
    /// \param size number of rows
    /// \param entries on and below the diagonal (column <= row); those of one position are added in order
    /// \throws BadInput naming an entry that is above the diagonal, outside or not finite
    /// \throws NotConverged when the matrix is not positive definite
    SparseFactor(std::size_t size, std::vector<SparseEntry> const& entries);
    SparseFactor(SparseFactor const&) = delete;
    SparseFactor& operator=(SparseFactor const&) = delete;
    SparseFactor(SparseFactor&& other) noexcept;
    SparseFactor& operator=(SparseFactor&& other) noexcept;
    ~SparseFactor();

    /// Solves A x = b.
    /// \param b `size` numbers
    /// \return x
    /// \throws BadInput when b has another size than the matrix
    std::vector<double> solve(std::vector<double> const& b) const;

private:
    struct Factor;
    std::unique_ptr<Factor> factor_;
};

} // namespace thalweg::solver
