// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/order/internal/require_trees.hpp>

#include <cmath>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>

namespace thalweg::network {

void require_trees(StreamNetwork const& network, std::string_view who) {
    for (std::size_t a = 0; a < network.arc_count(); ++a) {
        // A sum of square roots is a finite number only if every coordinate is one.
        if (!std::isfinite(network.length_m(a))) {
            throw BadInput(fmt::format("{}: arc {} has a coordinate that is not a number; mend the line", who, a + 1));
        }
    }
    for (NodeId n = 0; n < network.node_count(); ++n) {
        if (network.out_arcs(n).size() > 1) {
            throw BadInput(fmt::format("{}: {} arcs leave the node at ({:.3f}, {:.3f}); a river may leave a node once, "
                                       "remove the bifurcation",
                                       who, network.out_arcs(n).size(), network.node(n).at.x, network.node(n).at.y));
        }
    }
    for (NodeId n = 0; n < network.node_count(); ++n) {
        if (network.out(n) != no_arc && network.basin(n) == 0) {
            NodeId on_cycle = n;
            for (std::size_t step = 0; step < network.node_count(); ++step) {
                on_cycle = network.to(network.out(on_cycle));
            }
            throw BadInput(fmt::format("{}: the rivers run in a circle through the node at ({:.3f}, {:.3f}); turn or "
                                       "remove one of them",
                                       who, network.node(on_cycle).at.x, network.node(on_cycle).at.y));
        }
    }
}

} // namespace thalweg::network
