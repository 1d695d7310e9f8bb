// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/growth/tokunaga/grow_tokunaga.hpp>

// Idea: Somebody draws the main rivers, the program adds the tributaries. Each stroke becomes the
// trunk of a Tokunaga tree of its own, whose trunk links are pinned to places along the stroke. A
// stroke owns the land that is nearest to it (distances relative to the strokes' lengths, so that a
// short stroke takes little from a long one) within its reach. The side branches of the trunk are
// dealt to the banks in proportion to the land there, the largest first. Then all trees are spread
// over their land and settled together, as embed_tree does with one.
// Source: Northeast Normal University 2015, equation 9 (refinements by the length of a stroke);
// land and banks are ours: docs/decisions/0010-embedding.md.
// Cost: as embed_tree for the links of all strokes, besides pairs of strokes and a search over all
// strokes for each sample of land. One thread.
// Not for: rivers that stay as drawn and get no branches (network/import/import_lines.hpp); strokes
// that cross are refused. Trunks run along the stroke between evenly spaced nodes: bends shorter
// than their distance are cut.
// Example:
//     RiverLines strokes;
//     strokes.lines.push_back({.vertices = {{3000.0, 10.0, 0.0}, {2600.0, 4000.0, 0.0}}});
//     GrownStrokes const grown = grow_strokes(strokes, grid, {.tree = {.generator = 3}});
// More: docs/rivers.md, "Networks"; docs/algorithms/forest_spreading.md.

namespace thalweg::growth {

/// Options of grow_strokes().
struct StrokesParams {
    /// seed, rule, banks of side branches, and the generator of strokes without their own; order is not used
    TokunagaParams tree;
    int max_depth = 6;          ///< [1, 29] refinements of a stroke as long as the grid is wide
    double reach = 0.35;        ///< (0, 2] width of a stroke's area on each side, relative to its length
    double clearance = 0.35;    ///< as in EmbedParams
    double min_spacing_m = 0.0; ///< [m] as in EmbedParams
};

/// What grow_strokes() returns.
struct GrownStrokes {
    StreamNetwork network; ///< arcs have their stroke's type and feature
    std::int64_t placed = 0;
    std::int64_t dropped = 0;
};

/// Grows a network along every drawn stroke: its trunk follows the stroke, its branches fill the nearest land, on each
/// side as many links as there is land for.
/// \param strokes drawn upstream from their mouths; one that begins on another joins its trunk there
/// \param grid every stroke lies inside
/// \return refinements are round(length / width of the grid * max_depth), at least 1; arcs meet only at shared nodes
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput naming the stroke and position: fewer than two different vertices, at most half a cell long, a
/// vertex outside the grid, an unknown type, strokes that cross themselves or one another, or end, begin or join at the
/// same place, or leave one another no room where one begins on another
///
/// Source: \cite nenu2015, equation 9.
GrownStrokes grow_strokes(RiverLines const& strokes, Grid const& grid, StrokesParams const& params = {},
                          Run const& run = {});

} // namespace thalweg::growth
