// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/order/order.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include <gtest/gtest.h>
#include <network/networks.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

namespace order_test {

namespace {

using namespace thalweg;
using network::order;
using test::full_message_of;

std::string refusal(StreamNetwork const& net) {
    return full_message_of<BadInput>([&] { order(net); });
}

/// The definitions, recursively, straight from the graph.
struct Plain {
    StreamNetwork const& net;
    std::vector<ArcId> arcs;

    explicit Plain(StreamNetwork const& network) : net(network) {
        arcs.resize(net.arc_count());
        std::iota(arcs.begin(), arcs.end(), ArcId{0});
    }
    std::vector<std::size_t> above(NodeId node) const {
        std::vector<std::size_t> out;
        for (std::size_t a = 0; a < arcs.size(); ++a) {
            if (net.to(arcs[a]) == node) {
                out.push_back(a);
            }
        }
        return out;
    }
    std::vector<std::size_t> below(std::size_t arc) const {
        std::vector<std::size_t> out;
        for (std::size_t a = 0; a < arcs.size(); ++a) {
            if (net.from(arcs[a]) == net.to(arcs[arc])) {
                out.push_back(a);
            }
        }
        return out;
    }
    int strahler(std::size_t arc) const {
        std::vector<int> orders;
        for (std::size_t const a : above(net.from(arcs[arc]))) {
            orders.push_back(strahler(a));
        }
        if (orders.empty()) {
            return 1;
        }
        std::sort(orders.rbegin(), orders.rend());
        return orders.size() > 1 && orders[0] == orders[1] ? orders[0] + 1 : orders[0];
    }
    std::int64_t shreve(std::size_t arc) const {
        std::int64_t sum = 0;
        for (std::size_t const a : above(net.from(arcs[arc]))) {
            sum += shreve(a);
        }
        return sum == 0 ? 1 : sum;
    }
    int topological(std::size_t arc) const { return below(arc).empty() ? 1 : 1 + topological(below(arc)[0]); }
    double longest(std::size_t arc) const {
        double most = 0.0;
        for (std::size_t const a : above(net.from(arcs[arc]))) {
            most = std::max(most, longest(a));
        }
        return most + length_of(net.arc(arcs[arc]).line);
    }
    int hack(std::size_t arc) const {
        std::size_t stem = arc;
        for (std::size_t const a : above(net.to(arcs[arc]))) {
            if (longest(a) > longest(stem) || (longest(a) == longest(stem) && a < stem)) {
                stem = a;
            }
        }
        return (below(arc).empty() ? 1 : hack(below(arc)[0])) + (stem == arc ? 0 : 1);
    }
    double dist_out(NodeId node) const {
        double sum = 0.0;
        while (net.out_arcs(node).size() == 1) {
            ArcId const arc = net.out_arcs(node).front();
            sum += length_of(net.arc(arc).line);
            node = net.to(arc);
        }
        return sum;
    }
};

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
    EXPECT_NE(refusal(test::network_of({{0, 0}, {1, 2}, {5, 5}}, {{1, 0}, {1, 2}})).find("(1.000, 2.000)"),
              std::string::npos);
    // A river runs into a circle: the place named lies on the circle.
    std::string const text =
        refusal(test::network_of({{9, 9}, {1, 1}, {2, 1}, {2, 2}}, {{0, 1}, {1, 2}, {2, 3}, {3, 1}}));
    EXPECT_NE(text.find("network.order: "), std::string::npos);
    EXPECT_NE(text.find("circle"), std::string::npos);
    EXPECT_EQ(text.find("(9.000, 9.000)"), std::string::npos);
    EXPECT_NE(refusal(test::network_of({{0, 0}}, {{0, 0, {{1, 1}}}})).find("circle"), std::string::npos);
    EXPECT_NE(refusal(test::network_of({{0, 0}, {NAN, 1}}, {{1, 0}})).find("not a number"), std::string::npos);
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

TEST(Order, SeveralArcsIntoAnOutlet) {
    NetworkOrders const o = order(test::network_of({{0, 0}, {1, 0}, {0, 2}}, {{1, 0}, {2, 0}}));
    EXPECT_EQ(o.hack, (std::vector<int>{2, 1}));
    EXPECT_EQ(o.topological, (std::vector<int>{1, 1}));
    EXPECT_EQ(o.node_strahler[0], 1); // of what enters; nothing leaves
}

TEST(Order, EqualsTheDefinitions) {
    ASSERT_TRUE(rc::check("iterative = recursive", [] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        StreamNetwork const net = *rc::gen::arbitrary<bool>()
                                      ? test::random_skeleton(seed, 24)
                                      : test::random_forest(seed, *rc::gen::inRange<std::size_t>(0, 25),
                                                            *rc::gen::inRange<std::size_t>(1, 4));
        NetworkOrders const o = order(net);
        Plain const plain(net);
        for (std::size_t a = 0; a < plain.arcs.size(); ++a) {
            RC_ASSERT(o.strahler[a] == plain.strahler(a));
            RC_ASSERT(o.shreve[a] == plain.shreve(a));
            RC_ASSERT(o.topological[a] == plain.topological(a));
            RC_ASSERT(o.hack[a] == plain.hack(a));
            RC_ASSERT(o.arc_basin[a] == o.node_basin[net.from(plain.arcs[a])]);
        }
        for (NodeId n = 0; n < net.node_count(); ++n) {
            RC_ASSERT(std::fabs(o.node_dist_out_m[n] - plain.dist_out(n)) <= 1e-9);
            if (net.out(n) != no_arc) {
                RC_ASSERT(o.node_strahler[n] == o.strahler[net.out(n)]);
            }
        }
    }));
}

TEST(Order, AChainOfAMillionArcs) {
    NetworkOrders const o = order(test::chain(1000000));
    EXPECT_EQ(o.topological.back(), 1000000);
    EXPECT_EQ(o.strahler.front(), 1);
    EXPECT_EQ(o.node_dist_out_m.back(), 1e6);
}

} // namespace order_test
