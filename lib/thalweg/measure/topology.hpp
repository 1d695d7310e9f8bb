// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/network_file.hpp>
#include <thalweg/core/run.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::measure {

/// Kinds of finding, in the order of the checks (feature; amount):
/// empty (none; 0), bad_arc_id (arc; the id), duplicate_arc_id (arc; how many have it), duplicate_node_id (node; as
/// before), null_geometry (arc; its vertices), nan (arc or node; vertices that are no numbers below 1e18), zero_length
/// (arc; 0), repeated_vertex (arc; how many), z_rising (arc; greatest rise of a segment [m]), duplicate_geometry (arc;
/// id of the earlier arc on the same vertices, in either direction), missing_node (arc; the id), end_mismatch (arc;
/// distance of the arc's end from its node [m], which differ in a bit), several_outflows (node; how many),
/// isolated_node (node; 0), cycle (its first arc; arcs in it), no_outlet (first arc of the part; arcs in it),
/// ds_arc_mismatch, strahler_mismatch, shreve_mismatch (arc; the right value), basin_mismatch (arc; basin of the arc
/// downstream, or of another outlet; not checked when all are 0), not_simple (arc; places where it touches itself),
/// crossing (arc; id of the other arc).
struct TopologyReport {
    std::vector<Finding> findings; ///< feature = arc_id or node_id as the file has it
    std::vector<Check> checks;     ///< one a kind of fault, value = how many, limit 0
};

/// Checks a network as it stands in its file: ends, direction, trees, orders, heights, geometry, crossings.
/// Gives: no finding exactly when the file keeps every law of the network schema. Crossings are exact (CGAL).
/// Nothing in the file is believed: whatever it holds becomes findings, never an error. Orders are not checked below
/// a cycle, geometries without two distinct vertices not for crossings. Throws: Cancelled.
TopologyReport check_topology(NetworkFile const& file, Run const& run = {});

/// What a network will be in its file: arc_id is the arc's number and node_id the node's, both from 1.
/// Throws: BadInput when the orders are not those of the network.
NetworkFile as_file(RaisedNetwork const& network, NetworkOrders const& orders);

} // namespace thalweg::measure
