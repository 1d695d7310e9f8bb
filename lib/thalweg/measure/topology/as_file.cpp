// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/topology/topology.hpp>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>

namespace thalweg::measure {

NetworkFile as_file(ElevatedNetwork const& network, NetworkOrders const& orders) {
    std::size_t const nodes = network.plan.node_count();
    std::size_t const arcs = network.plan.arc_count();
    if (network.node_z.size() != nodes || network.arc_z.size() != arcs || orders.strahler.size() != arcs ||
        orders.shreve.size() != arcs || orders.arc_basin.size() != arcs) {
        throw BadInput(fmt::format("measure.as_file: heights or orders are not those of this network of {} arcs and {} "
                                   "nodes",
                                   arcs, nodes));
    }
    NetworkFile file;
    for (NodeId n = 0; n < nodes; ++n) {
        Vec2 const at = network.plan.node(n).at;
        file.nodes.push_back({static_cast<std::int64_t>(n) + 1, {at.x, at.y, network.node_z[n]}});
    }
    for (std::size_t a = 0; a < arcs; ++a) {
        auto const& line = network.plan.arc(a).line;
        auto const& z = network.arc_z[a];
        if (z.size() != line.size()) {
            throw BadInput(
                fmt::format("measure.as_file: arc {} has {} vertices but {} heights", a + 1, line.size(), z.size()));
        }
        NetworkFile::FileArc arc;
        arc.id = static_cast<std::int64_t>(a) + 1;
        arc.from_node = static_cast<std::int64_t>(network.plan.from(a)) + 1;
        arc.to_node = static_cast<std::int64_t>(network.plan.to(a)) + 1;
        arc.ds_arc = static_cast<std::int64_t>(network.plan.out(network.plan.to(a)) + 1); // 0 for none
        arc.strahler = orders.strahler[a];
        arc.shreve = orders.shreve[a];
        arc.basin = orders.arc_basin[a];
        for (std::size_t i = 0; i < line.size(); ++i) {
            arc.line.push_back({line[i].x, line[i].y, z[i]});
        }
        file.arcs.push_back(std::move(arc));
    }
    return file;
}

} // namespace thalweg::measure
