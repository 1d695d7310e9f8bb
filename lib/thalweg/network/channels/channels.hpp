// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/channels.hpp>
#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// Options of channels().
struct ChannelsParams {
    /// [0, 64] a cell flows to the farthest of this many cells downstream that is its neighbour
    std::int64_t look_cells = 8;
    std::int64_t stub_cells = 8; ///< [0, ...] shorter branches that begin at shared cells are left out
};

/// Channel cells and the arcs that run through them.
struct ChannelsOfArcs {
    Channels channels;
    /// by arc: numbers of its channel cells, downstream, each once, with that of the node it ends in
    std::vector<std::vector<std::int64_t>> of_arc;
    /// "captured", one an arc; feature as in carry_outlets; amount: cells of its path below
    std::vector<Finding> notes;
};

/// Draws a network into cells and finds each cell's receiver. A cell under several arcs belongs to the arc with the
/// fewest arcs to its outlet (ties: lower number). Loops within cells are cut. An arc that meets cells of another, or
/// would cross its diagonal step, flows into it there; this is noted where the other is not downstream. A cell then
/// flows to the farthest of the next look_cells that is its neighbour, and cells that lose their inflow are left out
/// unless they are sources, until nothing changes.
/// \param network a forest inside the grid
/// \param grid gives the cells (cells_along)
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return channels that keep their law, without heights. No two diagonal steps cross; no cell has a neighbour among
/// the next look_cells but its receiver, unless a diagonal lies between. Sources and outlets stay, outlets inside the
/// grid too.
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput for a vertex outside the grid or a network that is not a forest
/// \throws Cancelled
ChannelsOfArcs channels(StreamNetwork const& network, Grid const& grid, ChannelsParams const& params = {},
                        Run const& run = {});

} // namespace thalweg::network
