// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <thalweg/core/feature_points.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::skeleton {

/// What the slope of the surface is held to.
enum class SlopeMode : std::uint8_t {
    none,   ///< nothing
    centre, ///< equation 13: the slope of the surface in the middle of the grid
    mean    ///< root of the mean square over the grid's cells
};

/// The eighth term: the text of Zhang, Liu and Li lost an exponent. x2y2 completes the products {1, x, x^2} {1, y,
/// y^2}.
enum class EighthTerm : std::uint8_t { x2y2, x3y };

/// Options of regress().
struct RegressParams {
    double length_x = 20.0;   ///< [cells] > 0, correlation length along rows, of the terms around the middle
    double length_y = 20.0;   ///< [cells] > 0, along columns
    double frequency_x = 1.0; ///< [cycles a grid width] >= 0; 0 leaves its term out
    double frequency_y = 1.0; ///< [cycles a grid height] >= 0; 0 leaves its term out
    SlopeMode slope = SlopeMode::none;
    double slope_rad =
        0.0; ///< (0, pi/2) arctan of metres a cell, as Zhang, Liu and Li measure slopes; of centre and mean
    EighthTerm eighth = EighthTerm::x2y2;
};

/// A surface of twelve terms through points.
struct Regression {
    Raster<float> surface;
    /// Coefficients by term, x and y in [-1, 1] from the middle to the grid's outermost cell centres: 1, x, y, x^2, xy,
    /// y^2, x^2 y, eighth, x y^2, then e^(-|x|/Lx - |y|/Ly) times 1, cos and sin. 0 for a term left out.
    std::array<double, 12> coefficients{};
    std::size_t rank = 0;     ///< of the terms; below `terms` the points do not tell all of them
    std::size_t terms = 12;   ///< that were not left out
    double rms_m = 0.0;       ///< of the points' residuals
    double slope_error = 0.0; ///< |slope^2 / asked^2 - 1| in metres a cell; 0 under none
};

/// The surface of twelve linear terms that comes nearest to the points, with or without a given slope.
/// \pre at least as many points as terms; those outside the grid count too.
/// \param points the points
/// \param grid the grid
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return the least sum of squared residuals (with a slope: among all surfaces with that slope, to 1e-10). Lost rank
/// is reported, and the surface is then that of a small ridge.
/// \throws BadParameter
/// \throws BadInput too few points, a coordinate that is not finite, or (under centre) terms beside x and y that the
/// points do not tell apart
///
/// Source: \cite zhang, equations 12 and 13 (specification 1.4); c_a, which cannot be told apart from c_0 to c_2, is 1.
Regression regress(FeaturePoints const& points, Grid const& grid, RegressParams const& params = {},
                   Run const& run = {});

} // namespace thalweg::skeleton
