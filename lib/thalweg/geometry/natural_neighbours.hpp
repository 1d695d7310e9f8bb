// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>

// Idea: If a cell centre were added to the Voronoi diagram of the points, its region would be cut
// from those of its neighbours. The areas that it takes are the weights of their heights. Weights
// change smoothly with the place, reach only true neighbours, and need no radius or power. The
// surface passes through the points and is exact for planes.
// Source: Sibson 1981; CGAL.
// Cost: O(n log n) for n points and some operations for each neighbour of each cell. Rows run on
// all cores; each starts its walk through the triangles at the same face, so that bytes do not
// depend on threads.
// Not for: extrapolation: outside the convex hull there is no data, or the nearest point's height.
// Peaks are sharp at points, and no height exceeds its neighbours'. Breaklines: triangulate.hpp.
// Millions of cells take long: rasterise_tin (surface/tin/) is linear interpolation.
// Example:
//     std::vector<Vec3> const points = {{5.0, 5.0, 10.0}, {95.0, 5.0, 20.0}, {50.0, 90.0, 40.0}};
//     Raster<float> const z = natural_neighbours(points, grid);

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
