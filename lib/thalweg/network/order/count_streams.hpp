// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// Streams of a tree by Strahler order, and their side branches.
struct StreamCounts {
    std::int64_t links = 0;                          ///< all
    std::int64_t sources = 0;                        ///< links without another above
    int order = 0;                                   ///< of the outlet, the highest of several
    std::vector<std::int64_t> streams;               ///< by order - 1: N_w
    std::vector<std::vector<std::int64_t>> branches; ///< [w-1][k-1]: side branches of order w-k of streams of order w
    std::vector<double> side; ///< by k - 1: T_k, side branches of k orders less, the mean over streams of all orders
};

/// Counts streams and their side branches.
/// \param down for every link the one it flows into, a lower number, or -1
/// \return counts by Strahler's rule; where three or more links meet, all but one of the highest are branches.
/// \throws BadInput when a link flows into one of a higher number
///
/// Source: \cite strahler1957; \cite tokunaga1978; \cite peckham1995.
StreamCounts count_streams(std::vector<std::int64_t> const& down);

/// \param network the network
/// \return the same of a network of trees: its arcs are the links, whatever their order.
StreamCounts count_streams(StreamNetwork const& network);

} // namespace thalweg::network
