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

using NodeId = std::size_t; ///< number of a node: 0, 1, ... in order of insertion
using ArcId = std::size_t;  ///< number of an arc: 0, 1, ... in order of insertion
inline constexpr ArcId no_arc = std::numeric_limits<ArcId>::max();

/// A source, confluence or outlet.
struct Node {
    Vec2 at; ///< [m]
};

/// A reach between two nodes, directed downstream.
struct Arc {
    std::vector<Vec2> line;                                       ///< [m]
    double persistence = std::numeric_limits<double>::infinity(); ///< [cells] largest pruning length that keeps it
    std::int64_t feature = 0;                                     ///< id of its line in the file; 0: none
    std::string type;                                             ///< river type (Rosgen) from the file, or ""
    bool is_input = true;                                         ///< false: a side valley grown around input rivers
};

/// An arc and the nodes it joins.
struct DraftArc {
    NodeId from = 0;
    NodeId to = 0;
    Arc arc;
};

/// A network under construction, from which a StreamNetwork is made.
struct NetworkDraft {
    std::vector<Node> nodes;
    std::vector<DraftArc> arcs;

    NodeId add_node(Vec2 at);
    ArcId add_arc(NodeId from, NodeId to, Arc arc = {});
};

/// An immutable river network in plan: nodes, and arcs directed downstream, numbered in order of insertion. Heights,
/// orders and areas are vectors by number beside it. Include core/stream_network_graph.hpp to run Boost.Graph's
/// algorithms on it. Law: the ends of a line equal the positions of the arc's nodes bit for bit. Networks from stages
/// are forests (network::require_trees): at most one arc leaves a node, each component (basin) is a tree with one
/// outlet, and arcs meet only at shared nodes.
class StreamNetwork {
public:
    StreamNetwork() = default;

    /// Builds the network; sets the ends of lines to their nodes' positions; straightens a line of fewer than two
    /// vertices.
    /// \param draft nodes and arcs, in the order of their numbers
    /// \throws BadInput when an arc names a node that does not exist
    StreamNetwork(NetworkDraft draft); // implicit: a function that builds a network returns its draft

    /// Copies the network for changes.
    /// \return a draft with the same numbers
    NetworkDraft draft() const;

    std::size_t node_count() const { return nodes_.size(); }
    std::size_t arc_count() const { return arcs_.size(); }
    std::vector<Node> const& nodes() const { return nodes_; }
    std::vector<Arc> const& arcs() const { return arcs_; }
    Node const& node(NodeId n) const { return nodes_[n]; }
    Arc const& arc(ArcId a) const { return arcs_[a]; }

    NodeId from(ArcId a) const { return from_[a]; }
    NodeId to(ArcId a) const { return to_[a]; }
    /// The length of an arc in plan.
    /// \param a arc
    /// \return [m]
    double length_m(ArcId a) const { return length_m_[a]; }
    /// The upstream nodes.
    /// \return by arc
    std::vector<NodeId> const& from() const { return from_; }
    /// The downstream nodes.
    /// \return by arc
    std::vector<NodeId> const& to() const { return to_; }
    std::vector<double> const& length_m() const { return length_m_; }

    /// The arcs that end at a node.
    /// \param n node
    /// \return ascending
    std::span<ArcId const> in(NodeId n) const { return in_.of(n); }
    /// The arcs that leave a node.
    /// \param n node
    /// \return ascending; in a forest at most one
    std::span<ArcId const> out_arcs(NodeId n) const { return out_.of(n); }
    /// The arc downstream of a node.
    /// \param n node
    /// \return the last of several; no_arc: none
    ArcId out(NodeId n) const { return out_.of(n).empty() ? no_arc : out_.of(n).back(); }

    /// The outlets: nodes with arcs in and none out.
    /// \return ascending
    std::vector<NodeId> const& outlets() const { return outlets_; }
    /// The nodes that reach an outlet, in upstream order.
    /// \return each node after the one downstream of it
    std::vector<NodeId> const& upstream_order() const { return upstream_order_; }
    /// The basin of a node.
    /// \param n node
    /// \return 1, 2, ... in the order of outlets(); 0: the node reaches no outlet
    std::int64_t basin(NodeId n) const { return basin_[n]; }
    /// The basins.
    /// \return by node, as basin(n)
    std::vector<std::int64_t> const& basin() const { return basin_; }

private:
    /// Incident arcs of all nodes, in compressed rows.
    struct ArcsAt {
        std::vector<std::size_t> begin; ///< by node, plus the end
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

/// Kinds of nodes by their incident arcs, and sink: an outlet where the water ends, which arcs do not show.
enum class NodeKind : std::uint8_t { source, confluence, outlet, pseudo, sink };
/// \cpponly
NodeKind kind_of(StreamNetwork const& net, NodeId node);
char const* name_of(NodeKind kind);

/// The length of a polyline.
/// \param line vertices [m]
/// \return [m]
double length_of(std::vector<Vec2> const& line);

/// A network with heights.
struct ElevatedNetwork {
    StreamNetwork planform;                 ///< seen from above
    std::vector<double> node_z;             ///< [m] by node
    std::vector<std::vector<double>> arc_z; ///< [m] by arc, by vertex; ends equal node_z bit for bit
};

/// Stream orders and basins.
struct NetworkOrders {
    std::vector<int> strahler;           ///< [1, ...] by arc (Strahler 1957)
    std::vector<std::int64_t> shreve;    ///< [1, ...] by arc: number of sources upstream (Shreve 1966)
    std::vector<int> hack;               ///< [1, ...] by arc: 1 = main stem (Hack 1957)
    std::vector<int> topological;        ///< [1, ...] by arc: 1 at the outlet, increasing upstream
    std::vector<std::int64_t> arc_basin; ///< [1, ...] by arc
    std::vector<std::int64_t> node_basin;
    std::vector<int> node_strahler;      ///< of the stream that leaves the node (outlet: that enters)
    std::vector<double> node_dist_out_m; ///< [m] along the stream to the outlet
    std::vector<ArcId> main_stem;        ///< of the basin of the longest flow path, from its source down
};

} // namespace thalweg
