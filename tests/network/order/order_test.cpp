// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/order/order.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <network/networks.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

namespace order_test {

using namespace thalweg;
using network::order;
using network::streams;

namespace {

auto refused(StreamNetwork const& net, std::string const& words) {
    return test::refused(
        "network.order", [&] { order(net); }, words);
}

/// The definitions, recursively, straight from the graph.
struct Plain {
    StreamNetwork const& net;

    std::vector<ArcId> above(ArcId arc) const { return {net.in(net.from(arc)).begin(), net.in(net.from(arc)).end()}; }
    std::vector<ArcId> below(ArcId arc) const {
        return {net.out_arcs(net.to(arc)).begin(), net.out_arcs(net.to(arc)).end()};
    }
    int strahler(ArcId arc) const {
        std::vector<int> orders;
        for (ArcId const a : above(arc)) {
            orders.push_back(strahler(a));
        }
        if (orders.empty()) {
            return 1;
        }
        std::sort(orders.rbegin(), orders.rend());
        return orders.size() > 1 && orders[0] == orders[1] ? orders[0] + 1 : orders[0];
    }
    std::int64_t shreve(ArcId arc) const {
        std::int64_t sum = 0;
        for (ArcId const a : above(arc)) {
            sum += shreve(a);
        }
        return sum == 0 ? 1 : sum;
    }
    int topological(ArcId arc) const { return below(arc).empty() ? 1 : 1 + topological(below(arc)[0]); }
    double longest(ArcId arc) const {
        double most = 0.0;
        for (ArcId const a : above(arc)) {
            most = std::max(most, longest(a));
        }
        return most + length_of(net.arc(arc).line);
    }
    int hack(ArcId arc) const {
        ArcId stem = arc;
        for (ArcId const a : net.in(net.to(arc))) {
            if (longest(a) > longest(stem) || (longest(a) == longest(stem) && a < stem)) {
                stem = a;
            }
        }
        return (below(arc).empty() ? 1 : hack(below(arc)[0])) + (stem == arc ? 0 : 1);
    }
    double dist_out(ArcId arc) const {
        return length_of(net.arc(arc).line) + (below(arc).empty() ? 0.0 : dist_out(below(arc)[0]));
    }
};

using Labels = std::vector<std::int64_t>;

/// The definition: every arc runs down as long as the order stays; where that ends identifies the stream.
Labels walked(StreamNetwork const& network, NetworkOrders const& orders) {
    std::vector<std::size_t> last;
    for (std::size_t a = 0; a < network.arc_count(); ++a) {
        std::size_t at = a;
        for (std::int64_t below = network.out(network.to(at)); below >= 0; below = network.out(network.to(at))) {
            auto const next = static_cast<std::size_t>(below);
            if (orders.strahler[next] != orders.strahler[at]) {
                break;
            }
            at = next;
        }
        last.push_back(at);
    }
    std::set<std::size_t> const ends(last.begin(), last.end());
    Labels labels;
    for (std::size_t const end : last) {
        labels.push_back(1 + std::distance(ends.begin(), ends.find(end)));
    }
    return labels;
}

} // namespace

TEST(Order, EmptyAndOneArc) {
    EXPECT_TRUE(order(StreamNetwork()).strahler.empty());
    NetworkOrders const one = order(test::network_of({{0, 0}, {3, 4}, {9, 9}}, {{1, 0}}));
    EXPECT_EQ(one.strahler, std::vector<int>{1});
    EXPECT_EQ(one.shreve, std::vector<std::int64_t>{1});
    EXPECT_EQ(one.hack, std::vector<int>{1});
    EXPECT_EQ(one.topological, std::vector<int>{1});
    EXPECT_EQ(one.arc_basin, std::vector<std::int64_t>{1});
    EXPECT_EQ(one.node_basin, (std::vector<std::int64_t>{1, 1, 0})); // the third node belongs to no river
    EXPECT_EQ(one.node_strahler, (std::vector<int>{1, 1, 0}));
    EXPECT_EQ(one.node_dist_out_m, (std::vector<double>{0.0, 5.0, 0.0}));
}

TEST(Order, RefusesWhatIsNoForest) {
    EXPECT_TRUE(refused(test::network_of({{0, 0}, {1, 2}, {5, 5}}, {{1, 0}, {1, 2}}), "(1.000, 2.000)"));
    // A river runs into a circle: the place named lies on the circle.
    StreamNetwork const circle = test::network_of({{9, 9}, {1, 1}, {2, 1}, {2, 2}}, {{0, 1}, {1, 2}, {2, 3}, {3, 1}});
    EXPECT_TRUE(refused(circle, "circle"));
    EXPECT_FALSE(refused(circle, "(9.000, 9.000)"));
    EXPECT_TRUE(refused(test::network_of({{0, 0}}, {{0, 0, {{1, 1}}}}), "circle"));
    EXPECT_TRUE(refused(test::network_of({{0, 0}, {NAN, 1}}, {{1, 0}}), "not a number"));
}

TEST(Order, ASmallTreeByHand) {
    //  1   2   3      0 outlet; 4 and 5 confluences; 6 a pseudo node
    //   \ /   /       1-4 is longer than 2-4, the way by 4 longer than by 3
    //    4   /
    //     \ 6
    //      5 - 0
    StreamNetwork const net = test::network_of({{0, 0}, {2, 20}, {6, 16}, {14, 8}, {4, 10}, {6, 0}, {10, 4}},
                                               {{1, 4}, {2, 4}, {4, 5}, {3, 6}, {6, 5}, {5, 0}});
    NetworkOrders const o = order(net);
    EXPECT_EQ(o.strahler, (std::vector<int>{1, 1, 2, 1, 1, 2}));
    EXPECT_EQ(o.shreve, (std::vector<std::int64_t>{1, 1, 2, 1, 1, 3}));
    EXPECT_EQ(o.hack, (std::vector<int>{1, 2, 1, 2, 2, 1}));
    EXPECT_EQ(o.topological, (std::vector<int>{3, 3, 2, 3, 2, 1}));
    EXPECT_EQ(o.node_strahler, (std::vector<int>{2, 1, 1, 1, 2, 2, 1}));
}

TEST(Order, EqualPathsKeepTheLowerArc) {
    NetworkOrders const o = order(test::network_of({{0, 0}, {0, 1}, {-1, 2}, {1, 2}}, {{3, 1}, {2, 1}, {1, 0}}));
    EXPECT_EQ(o.hack, (std::vector<int>{1, 2, 1}));
}

TEST(Order, EqualsTheDefinitions) {
    ASSERT_TRUE(rc::check("iterative = recursive", [] {
        StreamNetwork const net = test::any_network();
        NetworkOrders const o = order(net);
        Plain const plain{net};
        for (ArcId a = 0; a < net.arc_count(); ++a) {
            RC_ASSERT(o.strahler[a] == plain.strahler(a));
            RC_ASSERT(o.shreve[a] == plain.shreve(a));
            RC_ASSERT(o.topological[a] == plain.topological(a));
            RC_ASSERT(o.hack[a] == plain.hack(a));
            RC_ASSERT(o.arc_basin[a] == o.node_basin[net.from(a)]);
        }
        for (NodeId n = 0; n < net.node_count(); ++n) {
            double const out_m = net.out(n) == no_arc ? 0.0 : plain.dist_out(net.out(n));
            RC_ASSERT(std::fabs(o.node_dist_out_m[n] - out_m) <= 1e-9 * (1.0 + out_m));
            RC_ASSERT((net.out(n) == no_arc || o.node_strahler[n] == o.strahler[net.out(n)]));
        }
        RC_ASSERT(streams(net, o) == walked(net, o));
        // The main stem: from the source farthest from its outlet, arc by arc.
        auto const farthest = std::ranges::max_element(o.node_dist_out_m);
        ArcId arc = net.arc_count() == 0 ? no_arc : net.out(static_cast<NodeId>(farthest - o.node_dist_out_m.begin()));
        for (ArcId const a : o.main_stem) {
            RC_ASSERT(o.node_dist_out_m[net.from(a)] == (arc == no_arc ? -1.0 : o.node_dist_out_m[net.from(arc)]));
            arc = net.out(net.to(a));
        }
        RC_ASSERT(arc == no_arc);
    }));
}

TEST(Order, AChainOfAMillionArcs) {
    NetworkOrders const o = order(test::chain(1000000));
    EXPECT_EQ(o.topological.back(), 1000000);
    EXPECT_EQ(o.strahler.front(), 1);
    EXPECT_EQ(o.node_dist_out_m.back(), 1e6);
}

TEST(Streams, EmptyAndOneArc) {
    EXPECT_TRUE(streams(StreamNetwork(), {}).empty());
    StreamNetwork const one = test::network_of({{0, 0}, {3, 4}, {9, 9}}, {{1, 0}});
    EXPECT_EQ(streams(one, order(one)), (Labels{1}));
}

TEST(Streams, RefusesOrdersOfAnotherNetworkAndWhatIsNoTree) {
    StreamNetwork const two = test::chain(2);
    EXPECT_THROW(streams(two, {}), BadInput);
    EXPECT_THROW(streams(two, order(test::chain(3))), BadInput);
    NetworkOrders const orders = order(two);
    EXPECT_THROW(streams(test::network_of({{0, 0}, {1, 2}, {5, 5}}, {{1, 0}, {1, 2}}), orders), BadInput);
    EXPECT_THROW(streams(test::network_of({{0, 0}, {1, 0}}, {{0, 1}, {1, 0}}), orders), BadInput);
}

TEST(CountStreams, CountsByHand) {
    using Down = std::vector<std::int64_t>;
    using Branches = std::vector<std::vector<std::int64_t>>;
    EXPECT_EQ(network::count_streams(Down{}).order, 0);
    // A stream of order 2 with one side branch, and beside it a lone link.
    auto const counts = network::count_streams(Down{-1, 0, 0, 1, 1, -1});
    EXPECT_EQ(counts.links, 6);
    EXPECT_EQ(counts.sources, 4);
    EXPECT_EQ(counts.streams, (std::vector<std::int64_t>{4, 1}));
    EXPECT_EQ(counts.branches[1], std::vector<std::int64_t>{1});
    EXPECT_EQ(counts.side, std::vector<double>{1.0});
    // Three equal streams: two form the order, the third is its branch; of unequal ones all but the highest are.
    EXPECT_EQ(network::count_streams(Down{-1, 0, 0, 0}).branches, (Branches{{}, {1}}));
    EXPECT_EQ(network::count_streams(Down{-1, 0, 0, 0, 0}).branches, (Branches{{}, {2}}));
    EXPECT_EQ(network::count_streams(Down{-1, 0, 0, 0, 1, 1}).branches, (Branches{{}, {2}}));
    EXPECT_THROW(network::count_streams(Down{0}), BadInput);
    EXPECT_THROW(network::count_streams(Down{1, -1}), BadInput);
}

} // namespace order_test
