// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::geometry {

/// Options of natural_neighbours().
struct NaturalNeighboursParams {
    /// Cells whose centre lies outside the points' hull: NaN, or the height of the nearest point.
    enum class Outside : std::uint8_t { no_data, nearest };
    Outside outside = Outside::no_data;
};

/// Heights of points carried to the centres of cells by Sibson's natural neighbours: each neighbour counts by the area
/// it would lose to a point set there.
/// \pre points as triangulate() does, of several at one place the first stands; a grid.
/// \param points the points
/// \param grid the grid
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return heights within those of the neighbours, those of the points where a centre is one; smooth but at the points,
/// and exact for planes. The same bytes for any order of the points but for the last bit, and any number of threads.
/// \throws BadInput like triangulate()
/// \throws Cancelled
///
/// Source: \cite sibson1981, A brief description of natural neighbour interpolation; CGAL.
Raster<float> natural_neighbours(std::vector<Vec3> const& points, Grid const& grid,
                                 NaturalNeighboursParams const& params = {}, Run const& run = {});

} // namespace thalweg::geometry
