// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/order/order.hpp>

#include <algorithm>

#include <thalweg/network/order/internal/require_trees.hpp>

namespace thalweg::network {

namespace {

/// Strahler's rule for the arcs that end in one node; 0 for none.
int strahler_below(std::span<ArcId const> in, std::vector<int> const& strahler) {
    int highest = 0;
    int how_many = 0;
    for (ArcId const a : in) {
        if (strahler[a] > highest) {
            highest = strahler[a];
            how_many = 0;
        }
        how_many += strahler[a] == highest ? 1 : 0;
    }
    return how_many > 1 ? highest + 1 : highest;
}

} // namespace

NetworkOrders order(StreamNetwork const& network) {
    require_trees(network, "network.order");
    std::size_t const arcs = network.arc_count();
    std::size_t const nodes = network.node_count();

    NetworkOrders orders;
    orders.strahler.assign(arcs, 0);
    orders.shreve.assign(arcs, 0);
    orders.hack.assign(arcs, 0);
    orders.topological.assign(arcs, 0);
    orders.arc_basin.assign(arcs, 0);
    orders.node_basin = network.basin();
    orders.node_strahler.assign(nodes, 0);
    orders.node_dist_out_m.assign(nodes, 0.0);

    std::vector<double> longest_above(nodes, 0.0); // [m] flow path from a source to the node
    std::vector<ArcId> main_stem(nodes, no_arc);   // the arc by which that path arrives
    for (auto n = network.upstream_order().rbegin(); n != network.upstream_order().rend(); ++n) {
        std::int64_t shreve = 0;
        for (ArcId const a : network.in(*n)) {
            shreve += orders.shreve[a];
            double const path = longest_above[network.from(a)] + network.length_m(a);
            if (main_stem[*n] == no_arc || path > longest_above[*n]) {
                main_stem[*n] = a;
                longest_above[*n] = path;
            }
            orders.node_strahler[*n] = std::max(orders.node_strahler[*n], orders.strahler[a]);
        }
        if (ArcId const out = network.out(*n); out != no_arc) {
            orders.strahler[out] = std::max(strahler_below(network.in(*n), orders.strahler), 1);
            orders.shreve[out] = std::max<std::int64_t>(shreve, 1);
            orders.node_strahler[*n] = orders.strahler[out];
        }
    }
    for (NodeId const n : network.upstream_order()) {
        ArcId const out = network.out(n);
        for (ArcId const a : network.in(n)) {
            orders.hack[a] = (out == no_arc ? 1 : orders.hack[out]) + (a == main_stem[n] ? 0 : 1);
            orders.topological[a] = (out == no_arc ? 0 : orders.topological[out]) + 1;
            orders.arc_basin[a] = network.basin(n);
            orders.node_dist_out_m[network.from(a)] = orders.node_dist_out_m[n] + network.length_m(a);
        }
    }
    return orders;
}

} // namespace thalweg::network
