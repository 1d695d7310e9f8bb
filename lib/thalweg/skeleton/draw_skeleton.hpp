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
    NoiseAlongParams noise; ///< of ridges; its origin is the grid's north-western corner
};

/// A skeleton and the origin of its cells.
struct DrawnSkeleton {
    Skeleton skeleton;
    std::int64_t river_cells = 0;
    std::int64_t ridge_cells = 0;
    std::int64_t point_cells = 0;
    std::int64_t under_rivers = 0; ///< cells of ridges or points that are river cells
    std::int64_t below_river = 0;  ///< ridge cells lower than a river in their 8 neighbours
};

/// Draws ridges and points into the cells that rivers leave free. Ridges run by Bresenham between vertices, with
/// heights linear between vertices, plus noise by the share of the ridge's length.
/// \param valley [m] heights of river cells
/// \param ridges in the grid's coordinates
/// \param points in the grid's coordinates
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return river cells bit for bit; else the highest point of a cell; else its highest ridge. Independent of the order
/// of ridges and points.
/// \throws BadInput naming feature and position: outside the grid, without a finite height, in another coordinate
/// system
/// \throws BadParameter when a parameter is outside its range
/// \throws Cancelled
///
/// Source: \cite nenu2015, section 3.1 and equation 11 (begun at the height of the ridge's start); specification 3.5.
DrawnSkeleton draw_skeleton(Valley const& valley, RidgeLines const& ridges, FeaturePoints const& points,
                            DrawSkeletonParams const& params = {}, Run const& run = {});

} // namespace thalweg::skeleton
