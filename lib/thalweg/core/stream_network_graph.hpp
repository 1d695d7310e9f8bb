// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <utility>

#include <boost/graph/graph_traits.hpp>
#include <boost/graph/properties.hpp>
#include <boost/iterator/counting_iterator.hpp>
#include <boost/property_map/property_map.hpp>

#include <thalweg/core/stream_network.hpp>

/// A StreamNetwork as a Boost graph: models IncidenceGraph, BidirectionalGraph, VertexListGraph and EdgeListGraph, with
/// property maps vertex_index, edge_index and edge_weight (length_m). Vertices are NodeIds, edges ArcIds. Include it in
/// .cpp files only: it includes Boost.

namespace boost {

template <> struct graph_traits<thalweg::StreamNetwork> {
    using vertex_descriptor = thalweg::NodeId;
    using edge_descriptor = thalweg::ArcId;
    using directed_category = bidirectional_tag;
    using edge_parallel_category = allow_parallel_edge_tag;
    struct traversal_category : virtual bidirectional_graph_tag,
                                virtual vertex_list_graph_tag,
                                virtual edge_list_graph_tag {};
    using vertex_iterator = counting_iterator<thalweg::NodeId>;
    using edge_iterator = counting_iterator<thalweg::ArcId>;
    using out_edge_iterator = thalweg::ArcId const*;
    using in_edge_iterator = thalweg::ArcId const*;
    using adjacency_iterator = void;
    using vertices_size_type = std::size_t;
    using edges_size_type = std::size_t;
    using degree_size_type = std::size_t;

    static vertex_descriptor null_vertex() { return std::numeric_limits<vertex_descriptor>::max(); }
};

template <> struct graph_traits<thalweg::StreamNetwork const> : graph_traits<thalweg::StreamNetwork> {};

template <> struct property_map<thalweg::StreamNetwork, vertex_index_t> {
    using type = typed_identity_property_map<thalweg::NodeId>;
    using const_type = type;
};

template <> struct property_map<thalweg::StreamNetwork, edge_index_t> {
    using type = typed_identity_property_map<thalweg::ArcId>;
    using const_type = type;
};

template <> struct property_map<thalweg::StreamNetwork, edge_weight_t> {
    using type =
        iterator_property_map<double const*, typed_identity_property_map<thalweg::ArcId>, double, double const&>;
    using const_type = type;
};

} // namespace boost

namespace thalweg {

using NetworkTraits = boost::graph_traits<StreamNetwork>;

inline std::size_t num_vertices(StreamNetwork const& net) {
    return net.node_count();
}
inline std::size_t num_edges(StreamNetwork const& net) {
    return net.arc_count();
}
inline std::pair<NetworkTraits::vertex_iterator, NetworkTraits::vertex_iterator> vertices(StreamNetwork const& net) {
    return {NetworkTraits::vertex_iterator(0), NetworkTraits::vertex_iterator(net.node_count())};
}
inline std::pair<NetworkTraits::edge_iterator, NetworkTraits::edge_iterator> edges(StreamNetwork const& net) {
    return {NetworkTraits::edge_iterator(0), NetworkTraits::edge_iterator(net.arc_count())};
}
inline NodeId source(ArcId arc, StreamNetwork const& net) {
    return net.from(arc);
}
inline NodeId target(ArcId arc, StreamNetwork const& net) {
    return net.to(arc);
}
inline std::pair<ArcId const*, ArcId const*> out_edges(NodeId node, StreamNetwork const& net) {
    std::span<ArcId const> const arcs = net.out_arcs(node);
    return {arcs.data(), arcs.data() + arcs.size()};
}
inline std::pair<ArcId const*, ArcId const*> in_edges(NodeId node, StreamNetwork const& net) {
    std::span<ArcId const> const arcs = net.in(node);
    return {arcs.data(), arcs.data() + arcs.size()};
}
inline std::size_t out_degree(NodeId node, StreamNetwork const& net) {
    return net.out_arcs(node).size();
}
inline std::size_t in_degree(NodeId node, StreamNetwork const& net) {
    return net.in(node).size();
}
inline std::size_t degree(NodeId node, StreamNetwork const& net) {
    return in_degree(node, net) + out_degree(node, net);
}

inline boost::typed_identity_property_map<NodeId> get(boost::vertex_index_t, StreamNetwork const&) {
    return {};
}
inline boost::typed_identity_property_map<ArcId> get(boost::edge_index_t, StreamNetwork const&) {
    return {};
}
inline boost::property_map<StreamNetwork, boost::edge_weight_t>::const_type get(boost::edge_weight_t,
                                                                                StreamNetwork const& net) {
    return {net.length_m().data(), boost::typed_identity_property_map<ArcId>()};
}
inline NodeId get(boost::vertex_index_t, StreamNetwork const&, NodeId node) {
    return node;
}
inline ArcId get(boost::edge_index_t, StreamNetwork const&, ArcId arc) {
    return arc;
}
inline double get(boost::edge_weight_t, StreamNetwork const& net, ArcId arc) {
    return net.length_m(arc);
}

} // namespace thalweg
