// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/order/order.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <network/networks.hpp>
#include <network/plain_streams.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/network/growth/tokunaga/embed_tree.hpp>

namespace order_test {

using namespace thalweg;
using network::order;
using network::streams;

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

using Labels = std::vector<std::int64_t>;

Labels streams_of(StreamNetwork const& network) {
    return streams(network, order(network));
}

/// The definition: every arc runs down as long as the order stays; streams are told apart by where that ends.
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

void check(StreamNetwork const& network) {
    NetworkOrders const orders = order(network);
    Labels const labels = streams(network, orders);
    RC_ASSERT(labels == walked(network, orders));
    for (std::size_t a = 0; a < labels.size(); ++a) {
        if (std::int64_t const out = network.out(network.to(a)); out >= 0) {
            auto const below = static_cast<std::size_t>(out);
            RC_ASSERT((labels[a] == labels[below]) == (orders.strahler[a] == orders.strahler[below]));
        }
    }
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
    EXPECT_TRUE(test::has(refusal(test::network_of({{0, 0}, {1, 2}, {5, 5}}, {{1, 0}, {1, 2}})), "(1.000, 2.000)"));
    // A river runs into a circle: the place named lies on the circle.
    std::string const text =
        refusal(test::network_of({{9, 9}, {1, 1}, {2, 1}, {2, 2}}, {{0, 1}, {1, 2}, {2, 3}, {3, 1}}));
    EXPECT_TRUE(test::has(text, "network.order: ", "circle"));
    EXPECT_FALSE(test::has(text, "(9.000, 9.000)"));
    EXPECT_TRUE(test::has(refusal(test::network_of({{0, 0}}, {{0, 0, {{1, 1}}}})), "circle"));
    EXPECT_TRUE(test::has(refusal(test::network_of({{0, 0}, {NAN, 1}}, {{1, 0}})), "not a number"));
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

TEST(Streams, EmptyAndOneArc) {
    EXPECT_TRUE(streams_of(StreamNetwork()).empty());
    EXPECT_TRUE(streams_of(test::network_of({{0, 0}, {1, 1}}, {})).empty());
    EXPECT_EQ(streams_of(test::network_of({{0, 0}, {3, 4}, {9, 9}}, {{1, 0}})), (Labels{1}));
}

TEST(Streams, RefusesOrdersOfAnotherNetworkAndWhatIsNoTree) {
    StreamNetwork const two = test::chain(2);
    EXPECT_THROW(streams(two, {}), BadInput);
    EXPECT_THROW(streams(two, order(test::chain(3))), BadInput);
    NetworkOrders const orders = order(two);
    EXPECT_THROW(streams(test::network_of({{0, 0}, {1, 2}, {5, 5}}, {{1, 0}, {1, 2}}), orders), BadInput);
    EXPECT_THROW(streams(test::network_of({{0, 0}, {1, 0}}, {{0, 1}, {1, 0}}), orders), BadInput);
}

TEST(Streams, FollowTheDefinition) {
    ASSERT_TRUE(rc::check("forests of any shape, pseudo nodes among them", [] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        auto const nodes = *rc::gen::inRange<std::size_t>(0, 120);
        auto const basins = *rc::gen::inRange<std::size_t>(1, 5);
        check(test::random_forest(seed, nodes, basins));
    }));
}

TEST(Streams, AreAsManyAsTheTreeHas) {
    network::TokunagaTree const tree = network::grow_tokunaga({.generator = 3, .order = 4});
    network::EmbeddedTree const embedded = network::embed_tree(
        tree, {.region = {{0, 0}, {1000, 0}, {1000, 1000}, {0, 1000}}, .mouth = {500, 0}, .clearance = 0.1});
    ASSERT_EQ(embedded.dropped, 0);
    NetworkOrders const orders = order(embedded.network);
    Labels const labels = streams(embedded.network, orders);
    std::map<int, std::set<std::int64_t>> of_order;
    for (std::size_t a = 0; a < labels.size(); ++a) {
        of_order[orders.strahler[a]].insert(labels[a]);
    }
    auto const counted = test::plain_streams(test::down_of(tree)).streams;
    ASSERT_EQ(of_order.size(), counted.size());
    for (auto const& [w, count] : counted) {
        EXPECT_EQ(static_cast<double>(of_order[w].size()), count) << w;
    }
}

} // namespace order_test
