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
    /// Values of cells outside the points' convex hull: NaN, or the nearest point's height.
    enum class Outside : std::uint8_t { no_data, nearest };
    Outside outside = Outside::no_data;
};

/// Interpolates heights at cell centres by Sibson's natural neighbours: each neighbour is weighted by the area it would
/// lose to a new point.
/// \param points finite; of several at one position the first counts
/// \param grid of the result
/// \return [m] by cell: within the range of the neighbours, bit for bit at points, exact for planes. The same bytes for
/// any number of threads, and, but for the last bit, any order of points.
/// \throws BadInput as triangulate()
///
/// Source: \cite sibson1981, A brief description of natural neighbour interpolation; CGAL.
Raster<float> natural_neighbours(std::vector<Vec3> const& points, Grid const& grid,
                                 NaturalNeighboursParams const& params = {}, Run const& run = {});

} // namespace thalweg::geometry
