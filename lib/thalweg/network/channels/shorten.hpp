// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/network/channels/channels.hpp>

namespace thalweg::network {

/// What shorten() returns.
struct Shortened {
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
Shortened shorten(StreamNetwork const& network, ChannelsOfArcs const& drawn, std::vector<std::int64_t> const& gone);

} // namespace thalweg::network
