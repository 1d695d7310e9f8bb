// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// Labels streams, chains of arcs of one Strahler order.
/// \param network a forest
/// \param orders orders of this network
/// \return by arc: labels from 1 in the order of the streams' last arcs; an arc has the label of the arc it flows into
/// exactly if both have one order and stream
/// \throws BadInput for orders of another network or a network that is not a forest
///
/// Source: \cite strahler1957.
std::vector<std::int64_t> streams(StreamNetwork const& network, NetworkOrders const& orders);

} // namespace thalweg::network
