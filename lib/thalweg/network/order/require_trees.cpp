// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/order/internal/require_trees.hpp>

#include <cmath>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>

namespace thalweg::network {

void require_trees(StreamNetwork const& network, NetworkIndex const& index, std::string_view who) {
    for (std::size_t a = 0; a < index.arcs.size(); ++a) {
        // A sum of square roots is a finite number only if every coordinate is one.
        if (!std::isfinite(index.length_m[a])) {
            throw BadInput(fmt::format("{}: arc {} has a coordinate that is not a number; mend the line", who, a + 1));
        }
    }
    for (NodeId n = 0; n < index.out.size(); ++n) {
        if (boost::out_degree(n, network) > 1) {
            throw BadInput(fmt::format("{}: {} arcs leave the node at ({:.3f}, {:.3f}); a river may leave a node once, "
                                       "remove the bifurcation",
                                       who, boost::out_degree(n, network), network[n].at.x, network[n].at.y));
        }
    }
    for (NodeId n = 0; n < index.out.size(); ++n) {
        if (index.out[n] >= 0 && index.basin[n] == 0) {
            NodeId on_cycle = n;
            for (std::size_t step = 0; step < index.out.size(); ++step) {
                on_cycle = index.to[static_cast<std::size_t>(index.out[on_cycle])];
            }
            throw BadInput(fmt::format("{}: the rivers run in a circle through the node at ({:.3f}, {:.3f}); turn or "
                                       "remove one of them",
                                       who, network[on_cycle].at.x, network[on_cycle].at.y));
        }
    }
}

} // namespace thalweg::network
