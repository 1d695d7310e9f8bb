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
    ChannelsOfArcs drawn;       ///< what is left of the channels, by the new numbers of cells and arcs
    std::vector<Finding> notes; ///< "shortened", one an arc; where: its new end, or its old one where all of it went;
                                ///< amount: metres
};

/// Takes the tips that are rivers no more off a network.
/// \pre a network, its channels, and numbers of channel cells, with each all that flow into it.
/// \param network the network
/// \param drawn what was drawn
/// \param gone numbers of channel cells
/// \return arcs at whose upper end the water is gone begin on their line, in the first cell that is left; those of
/// which nothing is left but the node they end in are left out, where two arcs remain at a node that had more they are
/// merged, as in prune. Lines are kept bit for bit from the new beginning on.
/// \throws BadInput for numbers of no channel, a cell into which some flow that stay, or channels of another network
Shortened shorten(StreamNetwork const& network, ChannelsOfArcs const& drawn, std::vector<std::int64_t> const& gone);

} // namespace thalweg::network
