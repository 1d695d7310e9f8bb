// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/stream_network.hpp>

// Idea: One walk from the sources down and one from the outlets up give all orders. Strahler's
// order rises by one where the two highest of the arcs that meet are equal, so that it grows with
// the logarithm of size; Shreve's counts sources; Hack's counts confluences at which one leaves a
// larger river, from the outlet up, and needs a main stem: the longest flow path, or what
// main_stems.hpp chose. Streams are chains of arcs of one Strahler order; counting which order each
// flows into gives Tokunaga's matrix.
// Source: Strahler 1957; Shreve 1966; Hack 1957; side branches: Tokunaga 1978, Peckham 1995.
// Cost: O(arcs + nodes) time and memory. One thread.
// Not for: networks with divergences: import_lines or divide() (import/from_file.hpp) makes a
// forest first. Orders depend on the scale of the network: compare them at one support area.
// Example:
//     NetworkOrders const orders = order(network);
//     int const of_the_outlet = orders.node_strahler[network.outlets().front()];
//     StreamCounts const counts = count_streams(network); // counts.side[0] is T_1
// More: measure/laws/network_laws.hpp fits laws to these numbers.

namespace thalweg::network {

/// Computes Strahler, Shreve, Hack and topological orders, basins and distances to the outlet.
/// \param network a forest
/// \param main_in by node, as main_inflows(): the arc by which the main stem goes on upstream; empty: that of the
/// longest flow path (ties: lower arc number)
/// \return by arc and by node; 0: a node without arcs
/// \throws BadInput naming the position of a node that two arcs leave, or of a cycle; for main_in of another network
///
/// Source: \cite strahler1957; \cite shreve1966; \cite hack1957.
NetworkOrders order(StreamNetwork const& network, std::vector<ArcId> const& main_in = {});

/// Labels streams, chains of arcs of one Strahler order.
/// \param network a forest
/// \param orders orders of this network
/// \return by arc: labels from 1 in the order of the streams' last arcs; an arc has the label of the arc it flows into
/// exactly if both have one order and stream
/// \throws BadInput for orders of another network or a network that is not a forest
///
/// Source: \cite strahler1957.
std::vector<std::int64_t> streams(StreamNetwork const& network, NetworkOrders const& orders);

/// Numbers of streams by Strahler order, and of side branches.
struct StreamCounts {
    std::int64_t links = 0;                          ///< all
    std::int64_t sources = 0;                        ///< links without others upstream
    int order = 0;                                   ///< of the outlet, the highest of several
    std::vector<std::int64_t> streams;               ///< by order - 1: N_w
    std::vector<std::vector<std::int64_t>> branches; ///< [w-1][k-1]: side branches of order w-k of streams of order w
    std::vector<double> side; ///< by k - 1: T_k, side branches k orders lower, the mean over streams of all orders
};

/// Counts streams and their side branches. Where links meet of which several have the highest order, two of these form
/// the next order and all others are its branches; else all but the one of the highest order are branches.
/// \param down by link: the link downstream, a lower number; -1: none
/// \return counts by Strahler's rule
/// \throws BadInput when a link flows into one with a higher number
///
/// Source: \cite strahler1957; \cite tokunaga1978; \cite peckham1995.
StreamCounts count_streams(std::vector<std::int64_t> const& down);

/// Counts the streams of a network, whose arcs are the links.
/// \param network a forest
/// \return as above
StreamCounts count_streams(StreamNetwork const& network);

} // namespace thalweg::network
