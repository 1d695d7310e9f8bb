// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/order/streams.hpp>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/network/order/internal/require_trees.hpp>

namespace thalweg::network {

std::vector<std::int64_t> streams(StreamNetwork const& network, NetworkOrders const& orders) {
    require_trees(network, "network.streams");
    std::size_t const arcs = network.arc_count();
    if (orders.strahler.size() != arcs) {
        throw BadInput(
            fmt::format("network.streams: {} orders for {} arcs; order this network", orders.strahler.size(), arcs));
    }
    std::vector<std::size_t> mouth(arcs); // the last arc of the stream
    for (NodeId const n : network.upstream_order()) {
        if (ArcId const a = network.out(n); a != no_arc) {
            ArcId const below = network.out(network.to(a));
            mouth[a] = below != no_arc && orders.strahler[below] == orders.strahler[a] ? mouth[below] : a;
        }
    }
    std::vector<std::int64_t> number(arcs, 0);
    std::int64_t count = 0;
    for (std::size_t a = 0; a < arcs; ++a) {
        if (mouth[a] == a) {
            number[a] = ++count;
        }
    }
    std::vector<std::int64_t> labels;
    for (std::size_t a = 0; a < arcs; ++a) {
        labels.push_back(number[mouth[a]]);
    }
    return labels;
}

} // namespace thalweg::network
