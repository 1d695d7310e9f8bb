// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/features.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

// Idea: Water parts midway between streams, so ridges are guessed as the places that are equally
// far from two of them: edges of a Voronoi diagram. `voronoi` takes points along the rivers, a cell
// apart, and keeps the edges between points of different streams; `segments` takes the rivers'
// segments, whose edges are exact medial lines: straight pieces and parabolas. A ridge rises above
// its rivers with the distance, by a gain, and no more beyond a limit. Parts nearer to a river than
// clear_m are cut out, pieces that touch a river are left out by exact tests, and the rest is
// joined to the longest lines.
// Source: Northeast Normal University 2015, section 3.1 and equation 10. Sites a cell apart, where
// it takes nodes of links, and medial lines are ours (docs/rivers.md, "What the thesis prints and
// what holds").
// Cost: a Delaunay triangulation (or segment diagram) of n sites and an exact search for crossings,
// O(n log n) in practice. One thread.
// Not for: real divides. Distance alone decides, so a deep valley and a shallow one share the land
// evenly; terrain in equilibrium (surface/equilibrium/) finds its divides by erosion. Ridges that
// are known come from a file: ridges_with_heights.
// Example:
//     std::vector<std::int64_t> const labels = {1, 1, 2}; // the stream of each arc
//     RidgeLines const lines = ridges(elevated, labels, grid, {.gain = 0.2, .farthest_m = 800.0});
// More: docs/rivers.md, "Ridges"; geometry/diagram.hpp.

namespace thalweg::skeleton {

/// Options of ridges().
struct RidgesParams {
    /// The sites of the Voronoi diagram: points along rivers, or the rivers' segments.
    enum class Method : std::uint8_t { voronoi, segments };
    Method method = Method::voronoi;
    double gain = 0.3;       ///< [m/m] >= 0, lambda: rise of a ridge above its rivers per distance
    double farthest_m = 0.0; ///< [m] >= 0, distance beyond which ridges do not rise; 0: none
    double spacing_m = 0.0;  ///< [m] >= 0, of points along rivers (voronoi); 0: one cell
    /// [m] >= 0, largest distance of chords from a ridge's curve (segments); 0: a tenth of a cell
    double tolerance_m = 0.0;
    double clear_m = 0.0; ///< [m] >= 0, parts closer to their rivers are left out; 0: half a cell
};

/// Builds ridges midway between streams, which rise with distance from them.
/// \param network the rivers, with heights
/// \param stream_of_arc by arc: label of its stream
/// \param grid bounds the ridges
/// \return lines inside the grid between streams of different labels. No ridge meets a river; ridges meet only at their
/// ends, where three streams are equally far or the grid ends. A vertex has the height max z + gain d over the nearest
/// river points, at distance d. left < right; sorted by left, right and position; empty for fewer than two labels.
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput when labels or heights are not the network's, or (segments) arcs meet away from their vertices
///
/// Source: \cite nenu2015, section 3.1 and equation 10.
RidgeLines ridges(ElevatedNetwork const& network, std::vector<std::int64_t> const& stream_of_arc, Grid const& grid,
                  RidgesParams const& params = {}, Run const& run = {});

// Ridges of a file.

/// A cell that a line runs through; the next one has a side in common.
struct CellOfLine {
    CellIndex cell = 0;
    double z_m = 0.0; ///< [m] NaN: none
};

/// \internal
/// Lists the cells of a line with its heights there.
/// \param line [m] inside the grid; heights may be NaN
/// \param grid gives the cells (cells_along)
/// \return from its first vertex to the last, no cell twice in a row
/// \throws BadInput when a vertex lies outside the grid
std::vector<CellOfLine> cells_of_line(std::vector<Vec3> const& line, Grid const& grid);

/// \internal
/// Gives ridges heights everywhere: those without rise from the nearest river cell.
/// \param lines of two vertices or more inside the grid, each with a height at all of them or none
/// \param valley [m] heights of river cells, at least one if a ridge has no heights
/// \param params gain and farthest_m count
/// \return in their order; one that had no heights has a vertex in each cell, at its centre
/// \throws BadInput when a vertex lies outside the grid, or there is no river
RidgeLines ridges_with_heights(RiverLines const& lines, Valley const& valley, RidgesParams const& params,
                               Run const& run = {});

/// \internal
/// Gives ridges the heights of a terrain.
/// \param lines inside the DEM
/// \param dem [m] NaN: no data, also in the result
RidgeLines ridges_on(RiverLines const& lines, Raster<float> const& dem);

/// \internal
/// Ridges as the points of a skeleton.
/// \param ridges with heights, inside the grid
/// \param grid gives the cells
/// \return [m] the highest of each cell at its centre, by cell
/// \throws BadInput when a vertex lies outside the grid
FeaturePoints as_points(RidgeLines const& ridges, Grid const& grid);

} // namespace thalweg::skeleton
