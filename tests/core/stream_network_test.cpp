// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/stream_network.hpp>

#include <algorithm>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/bellman_ford_shortest_paths.hpp>
#include <boost/graph/breadth_first_search.hpp>
#include <boost/graph/copy.hpp>
#include <boost/graph/dag_shortest_paths.hpp>
#include <boost/graph/depth_first_search.hpp>
#include <boost/graph/dijkstra_shortest_paths.hpp>
#include <boost/graph/dominator_tree.hpp>
#include <boost/graph/graph_concepts.hpp>
#include <boost/graph/graphviz.hpp>
#include <boost/graph/kruskal_min_spanning_tree.hpp>
#include <boost/graph/page_rank.hpp>
#include <boost/graph/reverse_graph.hpp>
#include <boost/graph/strong_components.hpp>
#include <boost/graph/topological_sort.hpp>
#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/stream_network_graph.hpp>

namespace stream_network_test {

namespace {

using namespace thalweg;
using test::message_of;

NetworkDraft nodes(std::vector<Vec2> const& at) {
    NetworkDraft net;
    for (Vec2 const p : at) {
        net.add_node(p);
    }
    return net;
}

BOOST_CONCEPT_ASSERT((boost::IncidenceGraphConcept<StreamNetwork>));

BOOST_CONCEPT_ASSERT((boost::BidirectionalGraphConcept<StreamNetwork>));

BOOST_CONCEPT_ASSERT((boost::VertexListGraphConcept<StreamNetwork>));

BOOST_CONCEPT_ASSERT((boost::EdgeListGraphConcept<StreamNetwork>));

BOOST_CONCEPT_ASSERT((boost::VertexAndEdgeListGraphConcept<StreamNetwork>));

BOOST_CONCEPT_ASSERT((boost::ReadablePropertyGraphConcept<StreamNetwork, NodeId, boost::vertex_index_t>));

BOOST_CONCEPT_ASSERT((boost::ReadablePropertyGraphConcept<StreamNetwork, ArcId, boost::edge_index_t>));

BOOST_CONCEPT_ASSERT((boost::ReadablePropertyGraphConcept<StreamNetwork, ArcId, boost::edge_weight_t>));

/// A tree: every node but node 0, the outlet, runs to one before it.
StreamNetwork random_tree(std::uint64_t seed, std::size_t nodes) {
    RandomStream words(seed, 1, 0);
    NetworkDraft draft;
    for (NodeId n = 0; n < nodes; ++n) {
        draft.add_node({words.real(), words.real()});
        if (n > 0) {
            draft.add_arc(n, static_cast<NodeId>(words.word() % n));
        }
    }
    return draft;
}

/// Three nodes in a circle and one that runs into it.
StreamNetwork circle() {
    NetworkDraft draft;
    for (double const x : {0.0, 1.0, 2.0, 3.0}) {
        draft.add_node({x, x * x});
    }
    draft.add_arc(0, 1);
    draft.add_arc(1, 2);
    draft.add_arc(2, 0);
    draft.add_arc(3, 0);
    return draft;
}

/// By node, the way to the outlet [m], by walking.
std::vector<double> ways_out(StreamNetwork const& net) {
    std::vector<double> way(net.node_count(), 0.0);
    for (NodeId const n : net.upstream_order()) {
        if (net.out(n) != no_arc) {
            way[n] = way[net.to(net.out(n))] + net.length_m(net.out(n));
        }
    }
    return way;
}

template <class Numbers> auto by_number(Numbers& numbers) {
    return boost::make_iterator_property_map(numbers.begin(), boost::typed_identity_property_map<std::size_t>());
}

struct CountBack : boost::default_dfs_visitor {
    explicit CountBack(int& back) : back_(&back) {}
    void back_edge(ArcId, StreamNetwork const&) { ++*back_; }

private:
    int* back_;
};

class StreamNetworkGraph : public testing::TestWithParam<std::uint64_t> {
protected:
    StreamNetwork const net = random_tree(GetParam(), 2 + 7 * GetParam());
    std::size_t const nodes = net.node_count();
};

INSTANTIATE_TEST_SUITE_P(RandomTrees, StreamNetworkGraph, testing::Range<std::uint64_t>(0, 12));

} // namespace

TEST(StreamNetwork, EmptyIndex) {
    EXPECT_TRUE(StreamNetwork().arcs().empty());
    EXPECT_TRUE(StreamNetwork().outlets().empty());
    EXPECT_TRUE(StreamNetwork().upstream_order().empty());
}

TEST(StreamNetwork, AnArcTakesTheEndsOfItsNodes) {
    NetworkDraft draft = nodes({{0, 0}, {3, 4}});
    Arc bent;
    bent.line = {{9, 9}, {1, 1}, {8, 8}};
    ArcId const straight = draft.add_arc(1, 0);
    ArcId const second = draft.add_arc(1, 0, bent);
    StreamNetwork const net(draft);
    EXPECT_EQ(net.arc(straight).line, (std::vector<Vec2>{{3, 4}, {0, 0}}));
    EXPECT_EQ(net.arc(second).line, (std::vector<Vec2>{{3, 4}, {1, 1}, {0, 0}}));
}

TEST(StreamNetwork, Length) {
    EXPECT_EQ(length_of({}), 0.0);
    EXPECT_EQ(length_of({{1, 1}}), 0.0);
    EXPECT_EQ(length_of({{0, 0}, {3, 4}, {3, 10}}), 11.0);
}

TEST(StreamNetwork, IndexOfTwoBasins) {
    //  1   2        4 - 3    5 alone
    //   \ /
    //    6 - 0
    NetworkDraft draft = nodes({{0, 0}, {2, 2}, {4, 2}, {9, 0}, {8, 0}, {7, 7}, {3, 1}});
    draft.add_arc(6, 0);
    draft.add_arc(4, 3);
    draft.add_arc(2, 6);
    draft.add_arc(1, 6);
    StreamNetwork const net(draft);
    EXPECT_EQ(net.from(), (std::vector<NodeId>{6, 4, 2, 1})); // numbered as they were added
    EXPECT_EQ(net.to(), (std::vector<NodeId>{0, 3, 6, 6}));
    std::vector<ArcId> const out{no_arc, 3, 2, no_arc, 1, no_arc, 0};
    for (NodeId n = 0; n < net.node_count(); ++n) {
        EXPECT_EQ(net.out(n), out[n]) << n;
        EXPECT_EQ(net.out_arcs(n).size(), out[n] == no_arc ? 0U : 1U) << n;
    }
    EXPECT_EQ(std::vector<ArcId>(net.in(6).begin(), net.in(6).end()), (std::vector<ArcId>{2, 3}));
    EXPECT_EQ(net.outlets(), (std::vector<NodeId>{0, 3})); // a node without arcs is no outlet
    EXPECT_EQ(net.basin(), (std::vector<std::int64_t>{1, 1, 1, 2, 2, 0, 1}));
    EXPECT_EQ(net.length_m(1), 1.0);
    std::vector<bool> seen(7, false);
    for (NodeId const n : net.upstream_order()) {
        if (net.out(n) != no_arc) {
            EXPECT_TRUE(seen[net.to(net.out(n))]) << n;
        }
        seen[n] = true;
    }
    EXPECT_EQ(net.upstream_order().size(), 6U);
}

TEST(StreamNetwork, NoOutletIsReachedFromACycle) {
    NetworkDraft draft = nodes({{0, 0}, {1, 0}, {2, 0}});
    draft.add_arc(0, 1);
    draft.add_arc(1, 0);
    draft.add_arc(2, 0);
    StreamNetwork const net(draft);
    EXPECT_TRUE(net.outlets().empty());
    EXPECT_EQ(net.basin(), (std::vector<std::int64_t>{0, 0, 0}));
}

TEST(StreamNetwork, ACopyKeepsTheNumbering) {
    NetworkDraft draft = nodes({{0, 0}, {1, 0}, {2, 0}, {3, 0}});
    draft.add_arc(3, 2);
    draft.add_arc(1, 0);
    draft.add_arc(2, 1);
    StreamNetwork const net(draft);
    StreamNetwork const copy = net;
    EXPECT_EQ(copy.from(), (std::vector<NodeId>{3, 1, 2}));
}

TEST(StreamNetwork, KindsOfNodes) {
    NetworkDraft draft = nodes({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {2, 1}});
    draft.add_arc(1, 0);
    draft.add_arc(2, 1);
    draft.add_arc(3, 2);
    draft.add_arc(4, 2);
    StreamNetwork const net(draft);
    EXPECT_EQ(std::string(name_of(kind_of(net, 0))), "outlet");
    EXPECT_EQ(std::string(name_of(kind_of(net, 1))), "pseudo");
    EXPECT_EQ(std::string(name_of(kind_of(net, 2))), "confluence");
    EXPECT_EQ(std::string(name_of(kind_of(net, 3))), "source");
}

TEST(StreamNetwork, OfSeveralArcsThatLeaveTheLastGoesOn) {
    NetworkDraft draft = nodes({{0, 0}, {1, 0}, {2, 0}});
    draft.add_arc(2, 0);
    draft.add_arc(2, 1);
    StreamNetwork const net(draft);
    EXPECT_EQ(net.out_arcs(2).size(), 2U);
    EXPECT_EQ(net.out(2), 1U);
}

TEST(StreamNetwork, RefusesArcsOfNodesThatAreNotThere) {
    NetworkDraft draft = nodes({{0, 0}, {1, 0}});
    draft.add_arc(0, 1);
    draft.add_arc(1, 2);
    EXPECT_EQ(message_of<BadInput>([&] { StreamNetwork const net(draft); }),
              "arc 2 ends at node 3 of 2; add the node first");
}

TEST(StreamNetwork, ItsDraftMakesItAgain) {
    NetworkDraft draft = nodes({{0, 0}, {1, 0}, {2, 0}});
    draft.add_arc(2, 1);
    draft.add_arc(1, 0);
    StreamNetwork const net(draft);
    NetworkDraft changed = net.draft();
    changed.nodes[0].at = {0, 7};
    StreamNetwork const moved(changed);
    EXPECT_EQ(moved.from(), net.from());
    EXPECT_EQ(moved.to(), net.to());
    EXPECT_EQ(moved.arc(1).line, (std::vector<Vec2>{{1, 0}, {0, 7}})); // ends follow their nodes
    EXPECT_EQ(net.arc(1).line, (std::vector<Vec2>{{1, 0}, {0, 0}}));
}

TEST_P(StreamNetworkGraph, TopologicalSortPutsWhatIsDownstreamFirst) {
    std::vector<NodeId> order; // Boost gives it from the end
    boost::topological_sort(net, std::back_inserter(order));
    std::vector<std::size_t> place(nodes);
    for (std::size_t i = 0; i < nodes; ++i) {
        place[order[i]] = i;
    }
    for (ArcId a = 0; a < net.arc_count(); ++a) {
        EXPECT_LT(place[net.to(a)], place[net.from(a)]);
    }
}

TEST_P(StreamNetworkGraph, DepthFirstSearchFindsNoWayBack) {
    int back = 0;
    boost::depth_first_search(net, boost::visitor(CountBack(back)));
    EXPECT_EQ(back, 0);
}

TEST_P(StreamNetworkGraph, BreadthFirstVisitOfTheReverseReachesAll) {
    std::vector<std::size_t> steps(nodes, 0);
    auto const upstream = boost::make_reverse_graph(net);
    boost::breadth_first_search(
        upstream, NodeId{0},
        boost::visitor(boost::make_bfs_visitor(boost::record_distances(by_number(steps), boost::on_tree_edge())))
            .vertex_index_map(boost::typed_identity_property_map<NodeId>()));
    for (ArcId a = 0; a < net.arc_count(); ++a) {
        EXPECT_EQ(steps[net.from(a)], steps[net.to(a)] + 1);
    }
}

TEST_P(StreamNetworkGraph, StrongComponentsOfATreeAreItsNodes) {
    std::vector<std::size_t> part(nodes);
    EXPECT_EQ(boost::strong_components(net, by_number(part)), nodes);
}

TEST_P(StreamNetworkGraph, DijkstraUpstreamGivesTheWaysOut) {
    std::vector<double> way(nodes);
    auto const upstream = boost::make_reverse_graph(net);
    boost::dijkstra_shortest_paths(upstream, NodeId{0}, boost::distance_map(by_number(way)));
    EXPECT_EQ(way, ways_out(net));
}

TEST_P(StreamNetworkGraph, BellmanFordDownstreamGivesTheWayOut) {
    NodeId const head = nodes - 1;
    std::vector<double> way(nodes);
    EXPECT_TRUE(boost::bellman_ford_shortest_paths(net, static_cast<int>(nodes),
                                                   boost::root_vertex(head).distance_map(by_number(way))));
    EXPECT_NEAR(way[0], ways_out(net)[head], 1e-12);
}

TEST_P(StreamNetworkGraph, DagShortestPathsGivesTheSameWay) {
    NodeId const head = nodes - 1;
    std::vector<double> way(nodes);
    boost::dag_shortest_paths(net, head, boost::distance_map(by_number(way)));
    EXPECT_NEAR(way[0], ways_out(net)[head], 1e-12);
}

TEST_P(StreamNetworkGraph, DominatorsUpstreamAreTheNodesDownstream) {
    std::vector<NodeId> dominator(nodes, NetworkTraits::null_vertex());
    auto const upstream = boost::make_reverse_graph(net);
    boost::lengauer_tarjan_dominator_tree(upstream, NodeId{0}, by_number(dominator));
    for (ArcId a = 0; a < net.arc_count(); ++a) {
        EXPECT_EQ(dominator[net.from(a)], net.to(a));
    }
}

TEST_P(StreamNetworkGraph, KruskalKeepsEveryArcOfATree) {
    std::vector<ArcId> kept;
    boost::kruskal_minimum_spanning_tree(net, std::back_inserter(kept));
    std::sort(kept.begin(), kept.end());
    ASSERT_EQ(kept.size(), net.arc_count());
    for (ArcId a = 0; a < kept.size(); ++a) {
        EXPECT_EQ(kept[a], a);
    }
}

TEST_P(StreamNetworkGraph, CopyGraphCopiesNodesAndArcs) {
    boost::adjacency_list<boost::vecS, boost::vecS, boost::bidirectionalS> copy;
    boost::copy_graph(net, copy, boost::vertex_copy([](NodeId, auto const&) {}).edge_copy([](ArcId, auto const&) {}));
    ASSERT_EQ(boost::num_vertices(copy), nodes);
    ASSERT_EQ(boost::num_edges(copy), net.arc_count());
    for (NodeId n = 0; n < nodes; ++n) {
        EXPECT_EQ(boost::in_degree(n, copy), net.in(n).size());
        EXPECT_EQ(boost::out_degree(n, copy), net.out_arcs(n).size());
    }
}

TEST_P(StreamNetworkGraph, RanksRiseDownstream) {
    std::vector<double> rank(nodes, 0.0);
    boost::graph::page_rank(net, by_number(rank), boost::graph::n_iterations(static_cast<std::size_t>(100)));
    for (NodeId n = 0; n < nodes; ++n) { // what flows in, damped, and the same for all
        double in = 0.15;
        for (ArcId const a : net.in(n)) {
            in += 0.85 * rank[net.from(a)];
        }
        EXPECT_NEAR(rank[n], in, 1e-9);
    }
}

TEST(StreamNetworkGraphText, Graphviz) {
    std::ostringstream text;
    boost::write_graphviz(text, circle());
    EXPECT_EQ(text.str(), "digraph G {\n0;\n1;\n2;\n3;\n0->1 ;\n1->2 ;\n2->0 ;\n3->0 ;\n}\n");
}

TEST(StreamNetworkGraphCycles, AreFound) {
    StreamNetwork const net = circle();
    std::vector<NodeId> order;
    EXPECT_THROW(boost::topological_sort(net, std::back_inserter(order)), boost::not_a_dag);
    int back = 0;
    boost::depth_first_search(net, boost::visitor(CountBack(back)));
    EXPECT_EQ(back, 1);
    std::vector<std::size_t> part(4);
    EXPECT_EQ(boost::strong_components(net, by_number(part)), 2U);
    EXPECT_EQ(part[0], part[2]);
    EXPECT_NE(part[0], part[3]);
}

TEST(StreamNetworkGraphEmpty, HasNothing) {
    StreamNetwork const none;
    EXPECT_EQ(num_vertices(none), 0U);
    EXPECT_TRUE(vertices(none).first == vertices(none).second);
    EXPECT_TRUE(edges(none).first == edges(none).second);
    std::vector<NodeId> order;
    boost::topological_sort(none, std::back_inserter(order));
    EXPECT_TRUE(order.empty());
}

} // namespace stream_network_test
