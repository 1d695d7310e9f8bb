// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/write_network.hpp>

#include <fmt/format.h>

#include <thalweg/core/error.hpp>
#include <thalweg/io/network_tables.hpp>

namespace thalweg::io {

namespace {

// The tables are parallel vectors: a wrong one would write another arc's numbers without a sound.
void require_whole(NetworkTables const& tables, NetworkIndex const& index, std::string const& what) {
    StreamNetwork const& plan = tables.network.plan;
    auto const& node_z = tables.network.node_z;
    auto const& arc_z = tables.network.arc_z;
    NetworkOrders const& orders = tables.orders;
    std::size_t const arcs = index.arcs.size();
    std::size_t const nodes = boost::num_vertices(plan);
    if (arcs == 0) {
        throw BadInput(what + ": the network has no arcs");
    }
    bool const by_arc = arc_z.size() == arcs && orders.strahler.size() == arcs && orders.shreve.size() == arcs &&
                        orders.hack.size() == arcs && orders.topological.size() == arcs &&
                        orders.arc_basin.size() == arcs && tables.us_area_m2.size() == arcs &&
                        tables.ds_area_m2.size() == arcs &&
                        (tables.braided == nullptr || tables.braided->size() == arcs);
    bool const by_node = node_z.size() == nodes && orders.node_basin.size() == nodes &&
                         orders.node_strahler.size() == nodes && orders.node_dist_out_m.size() == nodes &&
                         tables.node_area_m2.size() == nodes;
    if (!by_arc || !by_node) {
        throw BadInput(fmt::format(
            "{}: heights, orders, areas and what is braided do not have one value for each of {} arcs and {} nodes",
            what, arcs, nodes));
    }
    for (std::size_t i = 0; i < arcs; ++i) {
        auto const& line = plan[index.arcs[i]].line;
        NodeId const from = index.from[i];
        NodeId const to = index.to[i];
        bool const meets = line.size() >= 2 && arc_z[i].size() == line.size() && line.front() == plan[from].at &&
                           line.back() == plan[to].at && arc_z[i].front() == node_z[from] &&
                           arc_z[i].back() == node_z[to];
        if (!meets) {
            throw BadInput(
                fmt::format("{}: arc {} does not begin at node {} and end at node {}", what, i + 1, from + 1, to + 1));
        }
    }
    for (NodeId n = 0; n < nodes; ++n) {
        if (index.basin[n] == 0) {
            throw BadInput(
                fmt::format("{}: node {} at ({}, {}) reaches no outlet", what, n + 1, plan[n].at.x, plan[n].at.y));
        }
    }
}

void require_lines(RidgeLines const& ridges, std::string const& what) {
    for (std::size_t i = 0; i < ridges.lines.size(); ++i) {
        if (ridges.lines[i].line.size() < 2) {
            throw BadInput(fmt::format("{}: ridge {} between streams {} and {} has fewer than two vertices", what,
                                       i + 1, ridges.lines[i].left, ridges.lines[i].right));
        }
    }
}

Table run_table(std::map<std::string, std::string> const& rows) {
    std::vector<std::pair<std::string, std::string>> const list(rows.begin(), rows.end());
    auto const at = [](std::int64_t row) { return static_cast<std::size_t>(row); };
    return {"run",
            Table::Shape::none,
            static_cast<std::int64_t>(list.size()),
            {{"name", Column::Kind::text, 0, [=](std::int64_t row) { return list[at(row)].first; }},
             {"value", Column::Kind::text, 0, [=](std::int64_t row) { return list[at(row)].second; }}},
            {}};
}

} // namespace

void write_geopackage(NetworkTables const& tables, std::string const& path, Run const& run) {
    NetworkIndex const index(tables.network.plan);
    std::string const file = path.ends_with(".gpkg") ? path : path + ".gpkg";
    require_whole(tables, index, "io.write_geopackage: " + file);
    std::vector<Table> layers{arcs_table(tables, index), nodes_table(tables, index)};
    if (tables.ridges != nullptr && !tables.ridges->lines.empty()) {
        require_lines(*tables.ridges, "io.write_geopackage: " + file);
        layers.push_back(ridges_table(*tables.ridges));
    }
    layers.push_back(run_table(tables.run));
    write_tables(layers, tables.crs, file, run);
}

void write_shapefiles(NetworkTables const& tables, std::string const& path, Run const& run) {
    NetworkIndex const index(tables.network.plan);
    require_whole(tables, index, "io.write_shapefiles: " + path);
    write_shapefile(arcs_table(tables, index), tables.crs, path + "_arcs.shp", run);
    write_shapefile(nodes_table(tables, index), tables.crs, path + "_nodes.shp", run);
}

} // namespace thalweg::io
