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
    std::size_t rank = 0; ///< of the matrix; below its columns, x is the solution of a problem with a small ridge
    double rms = 0.0;     ///< root of the mean squared residual
};

/// The x that makes |A x - b| least, by QR with column pivoting.
/// \pre as many rows as b, at least one column.
/// \param a the matrix A
/// \param b the right side b
/// \return with full rank the one minimum; else the minimum of |A x - b|^2 + ridge |x|^2 with ridge 1e-10 of the
/// largest squared column norm.
/// \throws BadInput when sizes do not match or a number is not finite
Solution least_squares(Matrix const& a, std::vector<double> const& b);

/// A quadratic side condition on some of the unknowns: y' Q y = tau^2.
struct Sphere {
    std::vector<std::size_t> unknowns; ///< columns that form y, each once
    Matrix form;                       ///< Q: symmetric, positive definite
    double tau = 0.0;                  ///< > 0
};

/// The x that makes |A x - b| least among those that hold the side condition: the global minimum, by the secular
/// equation sum (h_i / (w_i + lambda))^2 = tau^2 with lambda > -w_min; in the hard case (no part of b along the weakest
/// direction) the missing length is added along it.
/// \param a the matrix A
/// \param b the right side b
/// \param sphere the quadratic side condition
/// \return |y' Q y - tau^2| <= 1e-10 tau^2.
/// \throws Error as least_squares
/// \throws BadParameter when tau is not positive or Q is not positive definite
/// \throws BadInput when the columns that are not in y lose rank
///
/// Source: \cite golub1991 (quadratically constrained least squares).
Solution least_squares_on_sphere(Matrix const& a, std::vector<double> const& b, Sphere const& sphere);

} // namespace thalweg::solver
