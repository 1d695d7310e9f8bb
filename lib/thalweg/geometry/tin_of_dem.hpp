// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/tin.hpp>

// Idea: A few large triangles suffice where terrain is even. Begin with the outline's corners;
// again and again the cell that is farthest from the triangles becomes a vertex, and the
// triangulation around it is made Delaunay again by flipping edges. Each triangle remembers its
// worst cell, so an insertion looks only at cells of the triangles that it changed, row by row.
// Candidates within a tenth of the greatest error wait in a heap, the others are looked through
// when it is empty. Coordinates are whole cells, so that orientation and circle tests are exact
// integers.
// Source: Garland and Heckbert 1995, algorithm III; outlines of holes and the short heap are ours.
// Cost: about O((n + m) log m) for n cells and m vertices. docs/performance.md: 279 ns and 36 bytes
// a cell for 2048 x 2048 at 5 m, 0.79 of the time of hmm. One thread, since each insertion follows
// from those before it.
// Not for: the least number of triangles (greedy insertion is near, not best); rivers as edges:
// they are vertices at most. Noise needs nearly all cells: give an error above it.
// Example:
//     SimplifiedDem const simple = tin_of_dem(dem, {.error_m = 2.0});
//     std::size_t const triangles = simple.tin.triangles.size();
// More: docs/commands.md, "TINs".

namespace thalweg::geometry {

/// Options of tin_of_dem().
struct TinOfDemParams {
    double error_m = 1.0; ///< [m] > 0, largest vertical distance of a cell from the TIN
};

/// A DEM as a TIN.
struct SimplifiedDem {
    Tin tin;
    double error_m = 0.0;      ///< [m] largest vertical distance reached
    std::int64_t left_out = 0; ///< cells with data in no triangle
};

/// Approximates a DEM by a TIN with few triangles, by greedy insertion of the worst cell (ties: lowest index) from the
/// corners of the outline on. The terrain is the squares between four neighbouring centres with data and the halves of
/// those with three; the outline of every hole is kept.
/// \param dem [m] by cell; NaN: no data
/// \return vertices are cell centres with their heights, in row order; at every other cell the TIN, computed in double,
/// is within error_m. Isolated cells and rows one cell wide lie in no triangle and are counted.
/// \throws BadParameter when error_m is not above 0
/// \throws BadInput when a height is infinite, a side has more than 2^20 cells, or no three neighbouring cells have
/// data
///
/// Source: \cite garland1995, Fast polygonal approximation of terrains and height fields, algorithm III.
SimplifiedDem tin_of_dem(Raster<float> const& dem, TinOfDemParams const& params = {}, Run const& run = {});

} // namespace thalweg::geometry
