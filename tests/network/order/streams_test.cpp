// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/order/order.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>
#include <network/networks.hpp>
#include <network/plain_streams.hpp>
#include <rapidcheck.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/network/growth/tokunaga/embed_tree.hpp>

namespace streams_test {

using namespace thalweg;
using network::order;
using network::streams;

namespace {

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

TEST(Streams, EmptyAndOneArc) {
    EXPECT_TRUE(streams_of(StreamNetwork()).empty());
    EXPECT_TRUE(streams_of(test::network_of({{0, 0}, {1, 1}}, {})).empty());
    EXPECT_EQ(streams_of(test::network_of({{0, 0}, {3, 4}, {9, 9}}, {{1, 0}})), (Labels{1}));
}

TEST(Streams, AChainIsOneStream) {
    EXPECT_EQ(streams_of(test::chain(40)), Labels(40, 1));
}

TEST(Streams, RefusesOrdersOfAnotherNetworkAndWhatIsNoTree) {
    StreamNetwork const two = test::chain(2);
    EXPECT_THROW(streams(two, {}), BadInput);
    EXPECT_THROW(streams(two, order(test::chain(3))), BadInput);
    NetworkOrders const orders = order(two);
    EXPECT_THROW(streams(test::network_of({{0, 0}, {1, 2}, {5, 5}}, {{1, 0}, {1, 2}}), orders), BadInput);
    EXPECT_THROW(streams(test::network_of({{0, 0}, {1, 0}}, {{0, 1}, {1, 0}}), orders), BadInput);
}

TEST(Streams, ASmallTreeByHand) {
    //  1   2   3      0 outlet, 4 and 5 confluences
    //   \ /   /
    //    4   /        1-4 and 2-4 meet as equals, 3-5 enters from the side and 5-0 goes on as 4-5
    //     \ /
    //      5
    //      |
    //      0
    StreamNetwork const tree =
        test::network_of({{0, 0}, {-2, 3}, {0, 3}, {2, 3}, {-1, 2}, {0, 1}}, {{5, 0}, {3, 5}, {1, 4}, {4, 5}, {2, 4}});
    EXPECT_EQ(streams_of(tree), (Labels{1, 2, 3, 1, 4}));
}

TEST(Streams, ArcsOfOneOrderThatEndInOneOutletDiffer) {
    EXPECT_EQ(streams_of(test::network_of({{0, 0}, {1, 0}, {0, 1}, {0, 2}}, {{3, 2}, {1, 0}, {2, 0}})),
              (Labels{2, 1, 2}));
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

} // namespace streams_test
