// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/feature_points.hpp>
#include <thalweg/core/ridge_lines.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/skeleton.hpp>
#include <thalweg/core/valley.hpp>
#include <thalweg/skeleton/noise_along.hpp>

namespace thalweg::skeleton {

/// Options of draw_skeleton().
struct DrawSkeletonParams {
    NoiseAlongParams noise; ///< of ridges; it counts from the grid's north-western corner
};

/// A skeleton, and its cells by what they were drawn for.
struct DrawnSkeleton {
    Skeleton skeleton;
    std::int64_t river_cells = 0;
    std::int64_t ridge_cells = 0;
    std::int64_t point_cells = 0;
    std::int64_t under_rivers = 0; ///< cells of ridges or points that are rivers
    std::int64_t below_river = 0;  ///< ridge cells lower than a river in one of the 8 cells around
};

/// Draws ridges and points into the cells that rivers leave free.
/// \pre a valley; ridges and points on its grid, whose outer edges belong to its outermost cells.
/// \param valley [m] heights of the river cells
/// \param ridges the ridge lines
/// \param points the points
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return the valley's cells bit for bit; elsewhere the highest point of a cell; elsewhere the highest of the ridges
/// that run through (Bresenham between vertices, height linear from vertex to vertex, and noise by the share of the
/// ridge's length). The order of ridges and points does not matter.
/// \throws BadInput naming feature and place: outside the grid, without a finite height, of another coordinate system
/// \throws BadParameter
/// \throws Cancelled
///
/// Source: \cite nenu2015, section 3.1 and equation 11 (begun at the height of the ridge's start); specification 3.5.
DrawnSkeleton draw_skeleton(Valley const& valley, RidgeLines const& ridges, FeaturePoints const& points,
                            DrawSkeletonParams const& params = {}, Run const& run = {});

} // namespace thalweg::skeleton
