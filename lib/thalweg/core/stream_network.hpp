// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <thalweg/core/vec.hpp>

namespace thalweg {

using NodeId = std::size_t; ///< number of a node: 0, 1, ... in the order of adding
using ArcId = std::size_t;  ///< number of an arc: 0, 1, ... in the order of adding
inline constexpr ArcId no_arc = std::numeric_limits<ArcId>::max();

/// A source, confluence or outlet.
struct Node {
    Vec2 at; ///< [m]
};

/// A reach between two nodes, drawn downstream.
struct Arc {
    std::vector<Vec2> line;                                       ///< [m]
    double persistence = std::numeric_limits<double>::infinity(); ///< [cells] largest L at which pruning keeps it
    std::int64_t feature = 0; ///< id of the line it came from in the file; 0 for none
    std::string type;         ///< river type given by the file (Rosgen), or ""
    bool is_input = true;     ///< false: a side valley that the land has grown around the given rivers
};

/// An arc and the nodes it joins.
struct DraftArc {
    NodeId from = 0;
    NodeId to = 0;
    Arc arc;
};

/// A network that a stage still builds or changes: a StreamNetwork is made from it.
struct NetworkDraft {
    std::vector<Node> nodes;
    std::vector<DraftArc> arcs;

    NodeId add_node(Vec2 at);
    ArcId add_arc(NodeId from, NodeId to, Arc arc = {});
};

/// A river network in plan: nodes, and arcs directed downstream, both numbered in the order in which they were added.
/// Without heights. Everything parallel to the network (orders, heights, areas) is a vector by number. It does not
/// change; stages that change networks make new ones from drafts. Boost.Graph's algorithms take it where
/// core/stream_network_graph.hpp is included. Law: the ends of every line equal the positions of the arc's nodes bit
/// for bit. What a stage gives is a forest besides (network::require_trees): at most one arc leaves a node, each
/// component (basin) is a tree that ends in one outlet, arcs meet only in shared nodes.
class StreamNetwork {
public:
    StreamNetwork() = default;

    /// Sets the ends of lines to the positions of their nodes; a line of fewer than two vertices becomes straight.
    /// \param draft nodes and arcs
    /// \throws BadInput where an arc names a node that is not there
    StreamNetwork(NetworkDraft draft); // implicit: a function that builds a network returns its draft

    /// A copy to change.
    /// \return the copy
    NetworkDraft draft() const;

    std::size_t node_count() const { return nodes_.size(); }
    std::size_t arc_count() const { return arcs_.size(); }
    std::vector<Node> const& nodes() const { return nodes_; }
    std::vector<Arc> const& arcs() const { return arcs_; }
    Node const& node(NodeId n) const { return nodes_[n]; }
    Arc const& arc(ArcId a) const { return arcs_[a]; }

    NodeId from(ArcId a) const { return from_[a]; }
    NodeId to(ArcId a) const { return to_[a]; }
    /// \param a the first
    /// \return length of its line
    double length_m(ArcId a) const { return length_m_[a]; }
    /// \return by arc
    std::vector<NodeId> const& from() const { return from_; }
    /// \return by arc
    std::vector<NodeId> const& to() const { return to_; }
    std::vector<double> const& length_m() const { return length_m_; }

    /// \param n the node
    /// \return numbers of the arcs that end in a node, ascending.
    std::span<ArcId const> in(NodeId n) const { return in_.of(n); }
    /// \param n the node
    /// \return numbers of the arcs that leave a node, ascending; in a forest at most one.
    std::span<ArcId const> out_arcs(NodeId n) const { return out_.of(n); }
    /// \param n the node
    /// \return the arc that leaves a node (of several the last), no_arc for none.
    ArcId out(NodeId n) const { return out_.of(n).empty() ? no_arc : out_.of(n).back(); }

    /// \return nodes with arcs in and none out, ascending.
    std::vector<NodeId> const& outlets() const { return outlets_; }
    /// \return every node that reaches an outlet, after the node downstream of it.
    std::vector<NodeId> const& upstream_order() const { return upstream_order_; }
    /// \param n the node
    /// \return 1, 2, ... as in outlets(); 0 where a node reaches none.
    std::int64_t basin(NodeId n) const { return basin_[n]; }
    /// \return by node
    std::vector<std::int64_t> const& basin() const { return basin_; }

private:
    /// The arcs at each node, one node after the other.
    struct ArcsAt {
        std::vector<std::size_t> begin; ///< by node, and one more
        std::vector<ArcId> arcs;

        ArcsAt() = default;
        ArcsAt(std::vector<NodeId> const& node_of_arc, std::size_t nodes);
        std::span<ArcId const> of(NodeId n) const { return std::span(arcs).subspan(begin[n], begin[n + 1] - begin[n]); }
    };

    void find_basins();

    std::vector<Node> nodes_;
    std::vector<Arc> arcs_;
    std::vector<NodeId> from_;
    std::vector<NodeId> to_;
    std::vector<double> length_m_;
    ArcsAt in_;
    ArcsAt out_;
    std::vector<NodeId> outlets_;
    std::vector<NodeId> upstream_order_;
    std::vector<std::int64_t> basin_;
};

/// Kinds of node by the arcs there; a sink is an outlet where the water does not go on, which arcs do not tell.
enum class NodeKind : std::uint8_t { source, confluence, outlet, pseudo, sink };
NodeKind kind_of(StreamNetwork const& net, NodeId node);
char const* name_of(NodeKind kind);

/// \param line the vertices
/// \return length of a polyline [m].
double length_of(std::vector<Vec2> const& line);

/// A network with heights: another type, so that heights cannot be asked before they are set.
struct ElevatedNetwork {
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
    std::vector<int> node_strahler;      ///< order of the stream that leaves the node (outlet: of the one that enters)
    std::vector<double> node_dist_out_m; ///< [m] along the stream to the outlet
};

} // namespace thalweg
