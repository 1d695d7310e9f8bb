// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/grid.hpp>
#include <thalweg/core/river_lines.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/network/growth/tokunaga/grow_tokunaga.hpp>

namespace thalweg::network {

/// Options of grow_strokes().
struct StrokesParams {
    TokunagaParams tree;        ///< seed, rule, the banks of all but the trunks' branches, and the generator of strokes
                                ///< without their own; order is not read
    int max_depth = 6;          ///< [1, 29] refinements of a stroke as long as the grid is wide
    double reach = 0.35;        ///< (0, 2] how far beside a stroke its land reaches, as a share of its length
    double clearance = 0.35;    ///< as in EmbedParams
    double min_spacing_m = 0.0; ///< [m] as in EmbedParams
};

/// What grow_strokes() returns.
struct GrownStrokes {
    StreamNetwork network; ///< arcs have the type and the feature of their stroke
    std::int64_t placed = 0;
    std::int64_t dropped = 0;
};

/// Grows a network along every stroke somebody drew: its trunk follows the stroke, its branches fill the land nearest
/// to it, on either side as many links as there is land.
/// \pre strokes from their mouth upstream, inside the grid. One that begins on another joins its trunk there.
/// \param strokes lines drawn from their mouth upstream
/// \param grid the grid
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return refinements = length / width of the grid * max_depth, rounded, at least 1 and at most max_depth; no two arcs
/// meet but in shared nodes.
/// \throws BadParameter
/// \throws BadInput naming the stroke and the place: fewer than two different vertices, half a cell or less, a vertex
/// outside the grid, an unknown type, a stroke that meets itself, two that cross, end on one another, begin or join at
/// the same place
/// \throws Cancelled
///
/// Source: \cite nenu2015, equation 9.
GrownStrokes grow_strokes(RiverLines const& strokes, Grid const& grid, StrokesParams const& params = {},
                          Run const& run = {});

} // namespace thalweg::network
