// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/network_file.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::measure {

/// Options of check_topology().
struct TopologyParams {
    double near_m = 0.0; ///< [m] >= 0: ends closer than this should have met, a line that comes back closer is a
                         ///< spike; 0 takes 1e-6 of the box's diagonal, which is where adopt joins ends
};

/// Kinds of finding, in the order of the checks (feature; amount): empty (none; 0), bad_arc_id (arc; the id),
/// duplicate_arc_id (arc; how many share the id), duplicate_node_id (node; as before), null_geometry (arc; its
/// vertices), nan (arc or node; vertices that are no numbers below 1e18), zero_length (arc; 0), repeated_vertex (arc;
/// how many), z_rising (arc; greatest rise of a segment [m]), duplicate_geometry (arc; id of the earlier arc on the
/// same vertices, in either direction), missing_node (arc; the id), end_mismatch (arc; distance of the arc's end from
/// its node [m], which differ in a bit), wrong_direction (arc; its length [m]: drawn from its to_node to its from_node,
/// or named in the other direction than ds_arc links it), dangling_end (arc; distance [m] from the arc it nearly
/// meets), several_outflows (node; how many), isolated_node (node; 0), cycle (its first arc; arcs in it), no_outlet
/// (first arc of the part; arcs in it; never without a cycle), ds_arc_mismatch, strahler_mismatch, shreve_mismatch
/// (arc; the right value), basin_mismatch (arc; the basin of most arcs above its outlet, or the one that is another
/// outlet's too; not checked when all are 0), column_mismatch (arc; the right value of n_up, topo_ord, hack, length,
/// length_3d, straight, z_up, z_down, dist_out, slope, us_area or ds_area, the least possible of areas),
/// node_column_mismatch (node; the right value of deg_in, deg_out, basin_id, strahler, z, area or dist_out; 0 for
/// kind), spike (arc; length [m] of the stretch on which it turns back), self_touching (arc; places where it touches or
/// crosses itself), touches (arc; id of the other, on which it ends, or whose end it runs through, where they have no
/// common node), overlap (arc; length [m] of the stretch it shares with an earlier arc), crossing (arc; id of an
/// earlier one that it crosses or touches inside).
struct TopologyReport {
    std::vector<Finding> findings; ///< in the order of the kinds; feature = arc_id or node_id as in the file
    std::vector<Check> checks;     ///< one a kind of fault, value = how many, limit 0
    std::vector<char> upstream;    ///< by arc: 1 where its line is drawn against the flow
};

/// Checks a network as it stands in its file: ends, direction, trees, orders, heights, geometry, meetings.
/// \param file the network as in its file
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return no finding exactly when the file keeps every law of the network schema, of what it says (NetworkFile::says).
/// Meetings are exact (CGAL). A fault is named once: what can be known in spite of it is checked as if it were mended.
/// So an arc on an earlier one's vertices is only that; an end that misses its node belongs to the node in its place;
/// an end that dangles to what it nearly meets. Orders and basins are not checked below a cycle or where a river
/// divides, since they are those of trees. Nothing in the file is believed: whatever it holds becomes findings, never
/// an error.
/// \throws BadParameter
/// \throws Cancelled
TopologyReport check_topology(NetworkFile const& file, TopologyParams const& params = {}, Run const& run = {});

/// \return the kinds of finding, in the order of the checks.
std::vector<std::string> topology_kinds();

/// \param network the network
/// \param orders the network's orders
/// \return what a network will be in its file: arc_id is the arc's number and node_id the node's, both from 1.
/// \throws BadInput when the orders are not those of the network
NetworkFile as_file(ElevatedNetwork const& network, NetworkOrders const& orders);

} // namespace thalweg::measure
