// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include <thalweg/solver/linear/matrix.hpp>

namespace thalweg::solver {

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

} // namespace thalweg::solver
