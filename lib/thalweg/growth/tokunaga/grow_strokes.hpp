// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/growth/tokunaga/grow_tokunaga.hpp>

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
