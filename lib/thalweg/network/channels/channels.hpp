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
    std::int64_t look_cells = 8; ///< [0, 64] a cell runs into the farthest of so many downstream that is its neighbour
    std::int64_t stub_cells = 8; ///< [0, ...] shorter ways that begin where rivers share cells are left out
};

/// Cells of rivers, and what runs through them.
struct ChannelsOfArcs {
    Channels channels;
    std::vector<std::vector<std::int64_t>> of_arc; ///< by arc number: the channel cells it runs through, by number,
                                                   ///< downstream, each once, with that of the node it ends in
    std::vector<Finding> notes;                    ///< "captured", one an arc; feature: as carry_outlets says it;
                                                   ///< amount: cells of its way below
};

/// Draws a network into cells and says where the water of each goes.
/// \pre a network inside the grid (cells_along; the grid's outer edges belong to its outermost cells).
/// \param network the network
/// \param grid the grid
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return channels that keep their law, without heights. A cell under several arcs belongs to that with the fewest
/// arcs to its outlet (ties: the lower number). Loops within cells are left out. An arc that meets cells of another, or
/// would step across its diagonal, flows into it there; that is noted where the other is not downstream of it. No two
/// diagonal steps cross. Then a cell flows into the farthest cell of the next look_cells downstream that is its
/// neighbour, and cells left without water from above that are no sources are left out, until nothing changes: no cell
/// has a neighbour among those look_cells but the next, unless a diagonal lies between. Sources stay. Outlets inside
/// the grid are roots too.
/// \throws BadParameter
/// \throws BadInput for a vertex outside the grid or a network that is not a forest
/// \throws Cancelled
ChannelsOfArcs channels(StreamNetwork const& network, Grid const& grid, ChannelsParams const& params = {},
                        Run const& run = {});

} // namespace thalweg::network
