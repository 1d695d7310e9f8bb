// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <boost/graph/adjacency_list.hpp>

#include <thalweg/core/vec.hpp>

namespace thalweg {

/// A source, confluence or outlet.
struct Node {
    Vec2 at; ///< [m]
};

/// A reach between two nodes, drawn downstream.
struct Arc {
    std::vector<Vec2> line; ///< [m] first and last vertex equal the positions of source(e) and target(e) bit for bit
    double survives = std::numeric_limits<double>::infinity(); ///< [cells] largest L at which pruning keeps it
    std::int64_t feature = 0;                                  ///< id of the line it came from in the file; 0 for none
    std::string type;                                          ///< river type given by the file (Rosgen), or ""
    bool given = true; ///< false: a side valley that the land has grown around the given rivers
};

/// A river network in plan: a Boost graph of arcs directed downstream. Without heights.
/// Law: every node has at most one arc leaving it; each component (basin) is a tree that ends in one outlet;
/// arcs meet only in shared nodes. boost::edges gives arcs in the order in which they were added: the arcs are
/// numbered by it, and everything parallel to the network (orders, heights, areas) is a vector by that number.
using StreamNetwork = boost::adjacency_list<boost::vecS, boost::vecS, boost::bidirectionalS, Node, Arc>;
using NodeId = boost::graph_traits<StreamNetwork>::vertex_descriptor;
using ArcId = boost::graph_traits<StreamNetwork>::edge_descriptor;

/// Adds an arc; the ends of its line are set to the positions of its nodes.
ArcId add_arc(StreamNetwork& net, NodeId from, NodeId to, Arc arc);

/// What stands around a network, by number: made once where a stage walks it.
struct NetworkIndex {
    explicit NetworkIndex(StreamNetwork const& net);

    std::vector<ArcId> arcs;                   ///< the arcs by number
    std::vector<NodeId> from;                  ///< by arc number
    std::vector<NodeId> to;                    ///< by arc number
    std::vector<std::int64_t> out;             ///< by node: number of the arc that leaves it, -1 for none
    std::vector<std::vector<std::int64_t>> in; ///< by node: numbers of the arcs that end in it, ascending
    std::vector<NodeId> upstream_order;        ///< every node after the node downstream of it
    std::vector<NodeId> outlets;               ///< nodes with arcs in and none out, ascending
    std::vector<std::int64_t> basin;           ///< by node: 1, 2, ... as in outlets; 0 where no outlet is reached
    std::vector<double> length_m;              ///< by arc number: length of its line
};

/// Kinds of node by the arcs there; a sink is an outlet where the water does not go on, which arcs do not tell.
enum class NodeKind : std::uint8_t { source, confluence, outlet, pseudo, sink };
NodeKind kind_of(StreamNetwork const& net, NodeId node);
char const* name_of(NodeKind kind);

/// Length of a polyline [m].
double length_of(std::vector<Vec2> const& line);

/// A network with heights: another type, so that heights cannot be asked before they are set.
struct RaisedNetwork {
    StreamNetwork plan;
    std::vector<double> node_z;             ///< [m] by node
    std::vector<std::vector<double>> arc_z; ///< [m] by arc number, one a vertex; ends equal node_z bit for bit
};

/// Orders of arcs and membership in basins.
struct NetworkOrders {
    std::vector<int> strahler;           ///< [1, ...] by arc (Strahler 1957)
    std::vector<std::int64_t> shreve;    ///< [1, ...] by arc: sources upstream (Shreve 1966)
    std::vector<int> hack;               ///< [1, ...] by arc: 1 = main stem (Hack 1957, by longest flow path)
    std::vector<int> topological;        ///< [1, ...] by arc: 1 at the outlet, growing upstream
    std::vector<std::int64_t> arc_basin; ///< [1, ...] by arc
    std::vector<std::int64_t> node_basin;
    std::vector<int> node_strahler;      ///< order of the stream that leaves the node (outlet: of that which enters)
    std::vector<double> node_dist_out_m; ///< [m] along the stream to the outlet
};

} // namespace thalweg
