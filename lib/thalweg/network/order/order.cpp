// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/order/order.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/network/order/internal/require_trees.hpp>

namespace thalweg::network {

void require_trees(StreamNetwork const& network, std::string_view who) {
    for (std::size_t a = 0; a < network.arc_count(); ++a) {
        // A sum of square roots is finite only if every coordinate is.
        refuse_if<BadInput>(!std::isfinite(network.length_m(a)), who,
                            "arc {} has a coordinate that is not a number; mend the line", a + 1);
    }
    for (NodeId n = 0; n < network.node_count(); ++n) {
        if (network.out_arcs(n).size() > 1) {
            throw BadInput(
                std::string(who),
                fmt::format(
                    "{} arcs leave the node at ({:.3f}, {:.3f}); a river may leave a node once, remove the bifurcation",
                    network.out_arcs(n).size(), network.node(n).at.x, network.node(n).at.y));
        }
    }
    for (NodeId n = 0; n < network.node_count(); ++n) {
        if (network.out(n) != no_arc && network.basin(n) == 0) {
            NodeId on_cycle = n;
            for (std::size_t step = 0; step < network.node_count(); ++step) {
                on_cycle = network.to(network.out(on_cycle));
            }
            throw BadInput(
                std::string(who),
                fmt::format(
                    "the rivers run in a circle through the node at ({:.3f}, {:.3f}); turn or remove one of them",
                    network.node(on_cycle).at.x, network.node(on_cycle).at.y));
        }
    }
}

namespace {

/// Strahler's rule for the arcs that end in one node; 0: none.
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

/// The arcs of the longest flow path, from its source down; of equal ones that with the lowest arc at its source.
std::vector<ArcId> longest_path(StreamNetwork const& network, NetworkOrders const& orders) {
    ArcId source = no_arc;
    double longest = -1.0;
    for (ArcId a = 0; a < network.arc_count(); ++a) {
        double const far = orders.node_dist_out_m[network.from(a)];
        if (far > longest) {
            longest = far;
            source = a;
        }
    }
    std::vector<ArcId> path;
    for (ArcId a = source; a != no_arc; a = network.out(network.to(a))) {
        path.push_back(a);
    }
    return path;
}

} // namespace

NetworkOrders order(StreamNetwork const& network, std::vector<ArcId> const& main_in) {
    require_trees(network, "network.order");
    std::size_t const arcs = network.arc_count();
    std::size_t const nodes = network.node_count();
    for (NodeId n = 0; n < nodes && !main_in.empty(); ++n) {
        bool const is_of_node =
            main_in.size() == nodes &&
            (network.in(n).empty() ? main_in[n] == no_arc : std::ranges::count(network.in(n), main_in[n]) == 1);
        refuse_if<BadInput>(!is_of_node, "network.order",
                            "main inflow {} does not end in node {}; give those of this network",
                            n < main_in.size() ? main_in[n] : no_arc, n);
    }

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
    std::vector<ArcId> longest_in(nodes, no_arc);  // the arc by which that path arrives
    for (auto n = network.upstream_order().rbegin(); n != network.upstream_order().rend(); ++n) {
        std::int64_t shreve = 0;
        for (ArcId const a : network.in(*n)) {
            shreve += orders.shreve[a];
            double const path = longest_above[network.from(a)] + network.length_m(a);
            if (longest_in[*n] == no_arc || path > longest_above[*n]) {
                longest_in[*n] = a;
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
    std::vector<ArcId> const& main = main_in.empty() ? longest_in : main_in;
    for (NodeId const n : network.upstream_order()) {
        ArcId const out = network.out(n);
        for (ArcId const a : network.in(n)) {
            orders.hack[a] = (out == no_arc ? 1 : orders.hack[out]) + (a == main[n] ? 0 : 1);
            orders.topological[a] = (out == no_arc ? 0 : orders.topological[out]) + 1;
            orders.arc_basin[a] = network.basin(n);
            orders.node_dist_out_m[network.from(a)] = orders.node_dist_out_m[n] + network.length_m(a);
        }
    }
    orders.main_stem = longest_path(network, orders);
    if (!main_in.empty() && !orders.main_stem.empty()) { // the main stem of the basin of the longest flow path
        NodeId node = network.to(orders.main_stem.back());
        orders.main_stem.clear();
        for (ArcId a = main[node]; a != no_arc; a = main[network.from(a)]) {
            orders.main_stem.push_back(a);
        }
        std::ranges::reverse(orders.main_stem);
    }
    return orders;
}

std::vector<std::int64_t> streams(StreamNetwork const& network, NetworkOrders const& orders) {
    require_trees(network, "network.streams");
    std::size_t const arcs = network.arc_count();
    refuse_if<BadInput>(orders.strahler.size() != arcs, "network.streams", "{} orders for {} arcs; order this network",
                        orders.strahler.size(), arcs);
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

StreamCounts count_streams(std::vector<std::int64_t> const& down) {
    std::size_t const links = down.size();
    StreamCounts counts;
    counts.links = static_cast<std::int64_t>(links);
    std::size_t orders = 0;
    std::vector<std::size_t> order(links, 1);
    std::vector<std::size_t> highest(links, 0); // among those upstream
    std::vector<int> equals(links, 0);          // number of those upstream with the highest order
    for (std::size_t i = links; i-- > 0;) {
        refuse_if<BadInput>(down[i] >= static_cast<std::int64_t>(i), "network.count_streams",
                            "link {} flows into link {}; number them from the outlet", i, down[i]);
        counts.sources += highest[i] == 0 ? 1 : 0;
        order[i] = std::max<std::size_t>(1, highest[i] + (equals[i] > 1 ? 1 : 0));
        orders = std::max(orders, order[i]);
        if (down[i] >= 0) {
            std::int64_t const below = down[i];
            if (order[i] > highest[below]) {
                highest[below] = order[i];
                equals[below] = 0;
            }
            equals[below] += order[i] == highest[below] ? 1 : 0;
        }
    }
    counts.order = static_cast<int>(orders);
    counts.streams.assign(orders, 0);
    counts.branches.assign(orders, {});
    for (std::size_t w = 0; w < orders; ++w) {
        counts.branches[w].assign(w, 0);
    }
    for (std::size_t i = 0; i < links; ++i) {
        bool const mouth = down[i] < 0;
        if (mouth || order[down[i]] != order[i]) {
            ++counts.streams[order[i] - 1];
        }
        if (!mouth && order[down[i]] > order[i] && order[i] < highest[down[i]]) {
            ++counts.branches[order[down[i]] - 1][order[down[i]] - order[i] - 1];
        }
        if (equals[i] > 2) { // two of them form the order
            counts.branches[order[i] - 1][0] += equals[i] - 2;
        }
    }
    for (std::size_t k = 1; k < orders; ++k) {
        std::int64_t side = 0;
        std::int64_t streams = 0;
        for (std::size_t w = k; w < orders; ++w) {
            side += counts.branches[w][k - 1];
            streams += counts.streams[w];
        }
        counts.side.push_back(static_cast<double>(side) / static_cast<double>(streams));
    }
    return counts;
}

StreamCounts count_streams(StreamNetwork const& network) {
    std::vector<std::int64_t> place(network.arc_count(), -1); // downstream before upstream
    std::vector<std::int64_t> down;
    for (NodeId const n : network.upstream_order()) {
        if (ArcId const arc = network.out(n); arc != no_arc) {
            ArcId const below = network.out(network.to(arc));
            place[arc] = static_cast<std::int64_t>(down.size());
            down.push_back(below == no_arc ? -1 : place[below]);
        }
    }
    return count_streams(down);
}

} // namespace thalweg::network
