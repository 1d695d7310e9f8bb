// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/channels.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/stream_network.hpp>

// Idea: Lines become cells as a plotter draws them: between two vertices the one cell a step that
// is nearest to the line, with heights linear along it. Where arcs share a cell the lowest height
// counts, which may make the next cell downstream of another arc the higher one. A flood over the
// steps from cell to cell, the lowest cells first, lowers all cells downstream of such a place.
// Source: Bresenham 1965 (core/cells.hpp); Cao, Long and Lü 2009, section 3.3.
// Cost: O(c log c) for c cells of rivers, besides the raster. One thread.
// Not for: flow directions along rivers, and cells that neighbour only their receiver:
// channels.hpp.
// Example:
//     RasterisedRivers const drawn = rasterise(elevated, grid);
//     Valley const& rivers = drawn.valley; // NaN where no river runs

namespace thalweg::network {

/// What rasterise() returns.
struct RasterisedRivers {
    Valley valley;
    std::int64_t lowered_cells = 0; ///< cells shared by several reaches, lowered so that each path falls
    double max_lowered_m = 0.0;
};

/// Draws arcs into cells (Bresenham between vertices, heights linear along the arc); a shared cell takes the lowest
/// height, and cells downstream are lowered to it.
/// \param network inside the grid
/// \param grid of the result
/// \return [m] by cell; NaN: no river. As float32, heights do not rise downstream along the cells of any arc.
/// \throws BadInput naming the arc and position of a vertex outside the grid or a height that is not a number
///
/// Source: \cite cao2009, section 3.3.
RasterisedRivers rasterise(ElevatedNetwork const& network, Grid const& grid);

/// Converts the heights of rivers to heights of channel cells.
/// \param network the rivers, with heights
/// \param channels channels of this network
/// \return [m] by channel cell: as rasterise, lowered so that no receiver is above its donor; NaN where no arc runs
/// \throws BadInput as rasterise
std::vector<float> channel_heights(ElevatedNetwork const& network, Channels const& channels);

} // namespace thalweg::network
