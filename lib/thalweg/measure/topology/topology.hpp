// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

// Idea: A river file is a set of trees only if ids, ends, directions, orders, heights and lines all
// agree. The checks run in an order in which each may rely on what those before it found, and a
// fault, once named, counts as repaired: an end that misses its node belongs to the node at its
// place, so that it causes no second tree and no wrong order. One fault then gives one finding, and
// a file without findings keeps every law of the schema. What lines do to one another in plan is
// decided by exact predicates without a tolerance; only dangling ends and spikes have one, near_m.
// Source: ours: docs/certificate.md, "The network", with all kinds in docs/findings.md.
// Cost: about O(vertices log vertices), and the search for crossings (geometry/crossings.hpp). One
// thread.
// Not for: repairing (check --fix does that); whether a DEM drains along the network
// (measure/drainage/certificate.hpp); whether directions are right where no column says so
// (network/import/import_lines.hpp).
// Example:
//     NetworkFile const file = as_file(elevated, network::order(elevated.planform));
//     TopologyReport const report = check_topology(file);
//     bool const is_sound = report.findings.empty();
// More: docs/certificate.md; docs/findings.md.

namespace thalweg::measure {

/// Options of check_topology().
struct TopologyParams {
    /// [m] >= 0, closer ends should have met, and a line that comes back closer is a spike; 0: 1e-6 of the box's
    /// diagonal, as import_lines joins ends
    double near_m = 0.0;
};

/// Results of check_topology(). Kinds of finding, in the order of the checks (feature; amount): empty (none; 0),
/// bad_arc_id (arc; the id), duplicate_arc_id (arc; number with this id), duplicate_node_id (node; number with this
/// id), null_geometry (arc; its vertices), nan (arc or node; vertices that are not numbers below 1e18), zero_length
/// (arc; 0), repeated_vertex (arc; number), z_rising (arc; largest rise of a segment [m]), duplicate_geometry (arc; id
/// of the earlier arc with the same vertices, in either direction), missing_node (arc; the id), end_mismatch (arc;
/// distance of its end from its node [m]; even one bit counts), wrong_direction (arc; length [m]: drawn from to_node to
/// from_node, or contrary to ds_arc), dangling_end (arc; distance [m] from the arc it nearly meets), several_outflows
/// (node; number), isolated_node (node; 0), cycle (its first arc; arcs in it), no_outlet (first arc of the part; arcs
/// in it; never without a cycle), ds_arc_mismatch, strahler_mismatch, shreve_mismatch (arc; the correct value),
/// basin_mismatch (arc; the basin of most arcs above its outlet, or one that another outlet has too; not checked when
/// all are 0), column_mismatch (arc; the correct value of n_up, topo_ord, hack, length, length_3d, straight, z_up,
/// z_down, dist_out, slope, us_area or ds_area; of areas the minimum), node_column_mismatch (node; the correct value of
/// deg_in, deg_out, basin_id, strahler, z, area or dist_out; 0 for kind), spike (arc; length [m] on which it turns
/// back), self_touching (arc; places where it touches or crosses itself), touches (arc; id of another on which it ends,
/// or whose end it runs through, without a common node), overlap (arc; length [m] shared with an earlier arc), crossing
/// (arc; id of an earlier one that it crosses or touches inside).
struct TopologyReport {
    std::vector<Finding> findings; ///< in the order of kinds; feature: arc_id or node_id of the file
    std::vector<Check> checks;     ///< one per kind of fault: value is the number, limit 0
    std::vector<char> upstream;    ///< by arc: 1: its line is drawn against the flow
};

/// Checks a network file: ends, directions, trees, orders, heights, geometry, intersections (exact). A fault is named
/// once; further checks assume it repaired: a duplicate arc is only that, an end that misses its node belongs to the
/// node in its place, a dangling end to what it nearly meets. Orders and basins are not checked below a cycle or a
/// bifurcation.
/// \param file as read, with any content
/// \return no finding exactly when the file satisfies every law of the network schema, for what it contains
/// (NetworkFile::says); bad content is a finding, never an error
/// \throws BadParameter when near_m is outside its range
TopologyReport check_topology(NetworkFile const& file, TopologyParams const& params = {}, Run const& run = {});

/// The kinds of finding.
/// \return in the order of the checks
std::vector<std::string> topology_kinds();

/// Converts a network to the content of its file.
/// \param network a forest with heights
/// \param orders orders of this network
/// \return arc_id and node_id are the number plus 1
/// \throws BadInput when the orders belong to another network
NetworkFile as_file(ElevatedNetwork const& network, NetworkOrders const& orders);

} // namespace thalweg::measure
