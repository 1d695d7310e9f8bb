// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/channels.hpp>
#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

// Idea: A solver needs rivers as cells, each with one receiver, and needs that water in a cell has
// no other way. Arcs are drawn from the outlets up, and a cell belongs to the arc that is nearest
// to its outlet; an arc that runs into cells of another goes on in it. Then short cuts are taken:
// where a river comes back beside itself within a few cells, water would jump by the steepest
// descent anyway, so that the cell is led to the farthest of the next cells that touches it, and
// what is cut off is left out. In the end no cell touches another of the next cells but its
// receiver, and steepest descent follows the river.
// Source: ours.
// Cost: O(c look_cells) for c cells a pass, in few passes, besides 4 bytes a cell of the grid. One
// thread.
// Not for: heights alone (vectorise/rasterise.hpp). Two rivers closer than a cell become one
// channel: the notes (`captured`) name them; smaller cells part them (import/choose_cell.hpp).
// Example:
//     ChannelsOfArcs const drawn = channels(network, grid);
//     std::int64_t const first = drawn.channels.cell[drawn.of_arc[0].front()]; // a cell's index

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
/// \return channels that keep their law, without heights. No two diagonal steps cross; no cell has a neighbour among
/// the next look_cells but its receiver, unless a diagonal lies between. Sources and outlets stay, outlets inside the
/// grid too.
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput for a vertex outside the grid or a network that is not a forest
ChannelsOfArcs channels(StreamNetwork const& network, Grid const& grid, ChannelsParams const& params = {},
                        Run const& run = {});

/// What shorten() returns.
struct ShortenedChannels {
    StreamNetwork network;
    ChannelsOfArcs drawn; ///< the remaining channels, with new numbers of cells and arcs
    /// "shortened", one an arc; where: its new upper end, or its old one if nothing remains; amount: [m]
    std::vector<Finding> notes;
};

/// Removes dry upper reaches from a network and its channels.
/// \param network the network the channels were drawn from
/// \param drawn its channels
/// \param gone numbers of channel cells; with a cell all that flow into it
/// \return arcs begin on their line in their first remaining cell; arcs with no cell left but their end node's are
/// removed, and where two arcs remain at a node that had more they are merged, as in prune. Lines are kept bit for bit
/// from the new beginning.
/// \throws BadInput for a number that is not a channel's, a removed cell with inflow that stays, or channels of another
/// network
ShortenedChannels shorten(StreamNetwork const& network, ChannelsOfArcs const& drawn,
                          std::vector<std::int64_t> const& gone);

} // namespace thalweg::network
