// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <thalweg/core/features.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

// Idea: Few points give a smooth surface: least squares over nine products of powers and three
// exponential terms (a hill at the centre, times 1, a cosine in x, a sine in y). The surface is
// linear in its twelve coefficients, so a QR decomposition finds them; coordinates are scaled to
// [-1, 1] to keep it well-conditioned. A given slope is a quadratic condition on the coefficients;
// least squares under one such condition has a global minimum that a one-dimensional (secular)
// equation finds.
// Source: Zhang, Liu and Li, equations 12 and 13; the condition by Golub and von Matt 1991. The
// eighth term is lost in print and chosen by EighthTerm.
// Cost: O(m) for m points, besides O(n) for n cells of the result (and as much again for the mean
// slope). Evaluation runs on all cores.
// Not for: surfaces through the points (geometry/natural_neighbours.hpp, triangulate.hpp):
// residuals are as large as the terrain is rough. A target slope that is the terrain's own makes
// the smooth surface far too steep; let fractal detail bring it. Fewer points than terms are
// refused; twice as many are better.
// Example:
//     Regression const fit = regress(points, grid, {.length_x = 20.0, .length_y = 40.0});
//     double const missed_m = fit.rms_m;
// More: docs/statistics.md, "From points".

namespace thalweg::skeleton {

/// The slope that constrains the regression.
enum class SlopeMode : std::uint8_t {
    none,   ///< no constraint
    centre, ///< equation 13: the slope of the surface at the grid's centre
    mean    ///< root mean square over the grid's cells
};

/// The eighth term, whose exponent is lost in \cite zhang. x2y2 completes the products {1, x, x^2} {1, y, y^2}.
enum class EighthTerm : std::uint8_t { x2y2, x3y };

/// Options of regress().
struct RegressParams {
    double length_x = 20.0;   ///< [cells] > 0, correlation length along rows, of the exponential terms
    double length_y = 20.0;   ///< [cells] > 0, along columns
    double frequency_x = 1.0; ///< [cycles a grid width] >= 0; 0 leaves its term out
    double frequency_y = 1.0; ///< [cycles a grid height] >= 0; 0 leaves its term out
    SlopeMode slope = SlopeMode::none;
    double slope_rad = 0.0; ///< [rad] (0, pi/2) arctan of metres per cell, as in \cite zhang; for centre and mean
    EighthTerm eighth = EighthTerm::x2y2;
};

/// A surface of twelve terms fitted to points.
struct Regression {
    Raster<float> surface;
    /// By term, x and y in [-1, 1] from the centre to the outermost cell centres: 1, x, y, x^2, xy, y^2, x^2 y, eighth,
    /// x y^2, then e^(-|x|/Lx - |y|/Ly) times 1, cos and sin. 0: the term is left out.
    std::array<double, 12> coefficients{};
    std::size_t rank = 0;     ///< of the matrix; below `terms` the points do not determine all terms
    std::size_t terms = 12;   ///< number of terms used
    double rms_m = 0.0;       ///< root mean square residual of the points
    double slope_error = 0.0; ///< |slope^2 / target^2 - 1| in metres per cell; none: 0
};

/// Fits a surface of twelve linear terms to points by least squares, optionally with a given slope.
/// \param points at least as many as terms; those outside the grid count too
/// \param grid of the result
/// \return the least sum of squared residuals (with a slope: among all surfaces of that slope, to 1e-10); if
/// rank-deficient, which is reported, that of a ridge regression
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput for too few points, a coordinate that is not finite, or (centre) points that do not determine the
/// terms besides x and y
///
/// Source: \cite zhang, equations 12 and 13; c_a, which cannot be told apart from c_0 to c_2, is 1.
Regression regress(FeaturePoints const& points, Grid const& grid, RegressParams const& params = {},
                   Run const& run = {});

} // namespace thalweg::skeleton
