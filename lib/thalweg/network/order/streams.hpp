// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// Which stream each arc belongs to: a stream is a chain of arcs of one Strahler order.
/// \pre a network whose components are trees, and its orders.
/// \param network the network
/// \param orders the network's orders
/// \return by arc number labels from 1, numbered by the streams' last arcs: where an arc flows into one of its own
/// order both have one label, elsewhere they differ.
/// \throws BadInput when the orders are of another network, or a component is not a tree
///
/// Source: \cite strahler1957.
std::vector<std::int64_t> streams(StreamNetwork const& network, NetworkOrders const& orders);

} // namespace thalweg::network
