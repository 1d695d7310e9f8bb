// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/internal/network_layers.hpp>

#include <cstddef>
#include <cstdint>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/network/internal/network_tables.hpp>
#include <thalweg/io/network/internal/schema_arcs.hpp>

namespace thalweg::io {

namespace {

void require_nameable(StreamNetwork const& plan, SchemaTable const& schema, std::string const& what) {
    auto const most = static_cast<std::size_t>(schema.most_upstream);
    for (NodeId n = 0; most > 0 && n < plan.node_count(); ++n) {
        if (plan.out(n) != no_arc && plan.in(n).size() > most) {
            throw BadInput(fmt::format("{}: {} rivers meet at ({}, {}), but {} names no more than {} upstream of one: "
                                       "split confluences (--max-upstream {})",
                                       what, plan.in(n).size(), plan.node(n).at.x, plan.node(n).at.y, schema.name, most,
                                       most));
        }
    }
}

} // namespace

void require_whole(NetworkTables const& tables, std::string const& what) {
    StreamNetwork const& plan = tables.network.plan;
    auto const& node_z = tables.network.node_z;
    auto const& arc_z = tables.network.arc_z;
    NetworkOrders const& orders = tables.orders;
    std::size_t const arcs = tables.network.plan.arc_count();
    std::size_t const nodes = plan.node_count();
    if (arcs == 0) {
        throw BadInput(what + ": the network has no arcs");
    }
    bool const by_arc = arc_z.size() == arcs && orders.strahler.size() == arcs && orders.shreve.size() == arcs &&
                        orders.hack.size() == arcs && orders.topological.size() == arcs &&
                        orders.arc_basin.size() == arcs && tables.us_area_m2.size() == arcs &&
                        tables.ds_area_m2.size() == arcs &&
                        (tables.braided == nullptr || tables.braided->size() == arcs) &&
                        (tables.user == nullptr || tables.user->record.size() == arcs);
    bool const by_node = node_z.size() == nodes && orders.node_basin.size() == nodes &&
                         orders.node_strahler.size() == nodes && orders.node_dist_out_m.size() == nodes &&
                         tables.node_area_m2.size() == nodes;
    if (!by_arc || !by_node) {
        throw BadInput(fmt::format(
            "{}: heights, orders, areas and what is braided do not have one value for each of {} arcs and {} nodes",
            what, arcs, nodes));
    }
    for (std::size_t i = 0; i < arcs; ++i) {
        auto const& line = plan.arc(i).line;
        NodeId const from = tables.network.plan.from(i);
        NodeId const to = tables.network.plan.to(i);
        bool const meets = line.size() >= 2 && arc_z[i].size() == line.size() && line.front() == plan.node(from).at &&
                           line.back() == plan.node(to).at && arc_z[i].front() == node_z[from] &&
                           arc_z[i].back() == node_z[to];
        if (!meets) {
            throw BadInput(
                fmt::format("{}: arc {} does not begin at node {} and end at node {}", what, i + 1, from + 1, to + 1));
        }
    }
    for (NodeId n = 0; n < nodes; ++n) {
        if (tables.network.plan.basin(n) == 0) {
            throw BadInput(fmt::format("{}: node {} at ({}, {}) reaches no outlet", what, n + 1, plan.node(n).at.x,
                                       plan.node(n).at.y));
        }
    }
}

std::vector<Table> network_layers(NetworkTables const& tables, Schema schema, bool short_names,
                                  std::string const& what) {
    require_whole(tables, what);
    if (schema == Schema::native) {
        return {arcs_table(tables, short_names), nodes_table(tables)};
    }
    require_nameable(tables.network.plan, table_of(schema), what);
    return {schema_arcs(table_of(schema), tables, short_names)};
}

} // namespace thalweg::io
