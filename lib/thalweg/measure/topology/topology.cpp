// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/topology/topology.hpp>

#include <algorithm>
#include <string_view>
#include <utility>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/measure/topology/internal/topology_steps.hpp>

namespace thalweg::measure {
namespace {

using namespace topology_steps;

constexpr std::array<std::string_view, 29> kinds = {"empty",
                                                    "bad_arc_id",
                                                    "duplicate_arc_id",
                                                    "duplicate_node_id",
                                                    "null_geometry",
                                                    "nan",
                                                    "zero_length",
                                                    "repeated_vertex",
                                                    "z_rising",
                                                    "duplicate_geometry",
                                                    "missing_node",
                                                    "end_mismatch",
                                                    "wrong_direction",
                                                    "dangling_end",
                                                    "several_outflows",
                                                    "isolated_node",
                                                    "cycle",
                                                    "no_outlet",
                                                    "ds_arc_mismatch",
                                                    "strahler_mismatch",
                                                    "shreve_mismatch",
                                                    "basin_mismatch",
                                                    "column_mismatch",
                                                    "node_column_mismatch",
                                                    "spike",
                                                    "self_touching",
                                                    "touches",
                                                    "overlap",
                                                    "crossing"};

std::size_t place_of(std::string_view kind) {
    return static_cast<std::size_t>(std::find(kinds.begin(), kinds.end(), kind) - kinds.begin());
}

double diagonal_of(Outlines const& plans) {
    bool any = false;
    Vec2 low;
    Vec2 high;
    for (auto const& line : plans) {
        for (Vec2 const p : line) {
            low = any ? Vec2{std::min(low.x, p.x), std::min(low.y, p.y)} : p;
            high = any ? Vec2{std::max(high.x, p.x), std::max(high.y, p.y)} : p;
            any = true;
        }
    }
    return distance(low, high);
}

} // namespace

std::vector<std::string> topology_kinds() {
    return {kinds.begin(), kinds.end()};
}

TopologyReport check_topology(NetworkFile const& file, TopologyParams const& params, Run const& run) {
    refuse_if<BadParameter>(!(params.near_m >= 0.0) || !is_number(params.near_m), "measure.check_topology",
                            "near_m = {}, it must be a distance [m] >= 0", params.near_m);
    TopologyReport report;
    Findings& findings = report.findings;
    if (file.arcs.empty()) {
        findings.push_back({"empty", 0, nowhere, 0.0, "the file holds no arcs"});
    }
    auto const ambiguous = check_ids(file, findings);
    Outlines plans = check_shapes(file, findings);
    auto left_out = check_copies(file, plans, findings);
    for (std::size_t a = 0; a < plans.size(); ++a) {
        if (left_out[a] != 0) {
            plans[a].clear();
        } else if (plans[a].empty() && file.arcs[a].from_node == file.arcs[a].to_node) {
            left_out[a] = 1; // the link has no target
        }
    }
    double const near_m = params.near_m > 0.0 ? params.near_m : 1e-6 * diagonal_of(plans);
    run.at(0.1, "check");
    Joints joints = check_ends(file, plans, left_out, ambiguous, findings);
    check_near_ends(file, plans, left_out, near_m, joints, findings, run);
    check_heights(file, plans, left_out, joints, findings);
    report.upstream = joints.against;
    run.at(0.3, "check");
    std::size_t const junctions = joints.junctions.ids.size();
    check_trees(file, joints, Graph(joints.said, left_out, junctions), findings);
    Graph const meant(joints.meant, left_out, junctions);
    check_numbers(file, joints, meant, ambiguous, findings);
    check_columns(file, joints, meant, findings);
    run.at(0.4, "check");
    check_meetings(file, plans, joints, near_m, findings, run);
    std::stable_sort(findings.begin(), findings.end(),
                     [](Finding const& p, Finding const& q) { return place_of(p.kind) < place_of(q.kind); });
    for (std::string_view const kind : kinds) {
        auto const found =
            std::count_if(findings.begin(), findings.end(), [&](Finding const& f) { return f.kind == kind; });
        report.checks.push_back({std::string(kind), static_cast<double>(found), 0.0, found == 0});
    }
    return report;
}

NetworkFile as_file(ElevatedNetwork const& network, NetworkOrders const& orders) {
    std::size_t const nodes = network.planform.node_count();
    std::size_t const arcs = network.planform.arc_count();
    refuse_if<BadInput>(
        network.node_z.size() != nodes || network.arc_z.size() != arcs || orders.strahler.size() != arcs ||
            orders.shreve.size() != arcs || orders.arc_basin.size() != arcs,
        "measure.as_file", "heights or orders are not those of this network of {} arcs and {} nodes", arcs, nodes);
    NetworkFile file;
    for (NodeId n = 0; n < nodes; ++n) {
        Vec2 const at = network.planform.node(n).at;
        file.nodes.push_back({static_cast<std::int64_t>(n) + 1, {at.x, at.y, network.node_z[n]}});
    }
    for (std::size_t a = 0; a < arcs; ++a) {
        auto const& line = network.planform.arc(a).line;
        auto const& z = network.arc_z[a];
        refuse_if<BadInput>(z.size() != line.size(), "measure.as_file", "arc {} has {} vertices but {} heights", a + 1,
                            line.size(), z.size());
        NetworkFile::FileArc arc;
        arc.id = static_cast<std::int64_t>(a) + 1;
        arc.from_node = static_cast<std::int64_t>(network.planform.from(a)) + 1;
        arc.to_node = static_cast<std::int64_t>(network.planform.to(a)) + 1;
        arc.ds_arc = static_cast<std::int64_t>(network.planform.out(network.planform.to(a)) + 1); // 0: none
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
