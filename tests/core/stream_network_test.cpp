// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/stream_network.hpp>

#include <string>

#include <gtest/gtest.h>

namespace {

using namespace thalweg;

StreamNetwork nodes(std::vector<Vec2> const& at) {
    NetworkDraft net;
    for (Vec2 const p : at) {
        net.add_node(p);
    }
    return net;
}

} // namespace

TEST(StreamNetwork, EmptyIndex) {
    EXPECT_TRUE(StreamNetwork().arcs.empty());
    EXPECT_TRUE(StreamNetwork().outlets().empty());
    EXPECT_TRUE(StreamNetwork().upstream_order().empty());
}

TEST(StreamNetwork, AnArcTakesTheEndsOfItsNodes) {
    StreamNetwork net = nodes({{0, 0}, {3, 4}});
    ArcId const straight = net.add_arc(1, 0);
    EXPECT_EQ(net.arc(straight).line, (std::vector<Vec2>{{3, 4}, {0, 0}}));
    Arc bent;
    bent.line = {{9, 9}, {1, 1}, {8, 8}};
    ArcId const second = net.add_arc(1, 0, bent);
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
    StreamNetwork net = nodes({{0, 0}, {2, 2}, {4, 2}, {9, 0}, {8, 0}, {7, 7}, {3, 1}});
    net.add_arc(6, 0);
    net.add_arc(4, 3);
    net.add_arc(2, 6);
    net.add_arc(1, 6);
    EXPECT_EQ(net.from(), (std::vector<NodeId>{6, 4, 2, 1})); // numbered as they were added
    EXPECT_EQ(net.to(), (std::vector<NodeId>{0, 3, 6, 6}));
    EXPECT_EQ(net.out@@, (std::vector<std::int64_t>{-1, 3, 2, -1, 1, -1, 0}));
    EXPECT_EQ(net.in(6), (std::vector<std::int64_t>{2, 3}));
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
    StreamNetwork net = nodes({{0, 0}, {1, 0}, {2, 0}});
    net.add_arc(0, 1);
    net.add_arc(1, 0);
    net.add_arc(2, 0);
    EXPECT_TRUE(net.outlets().empty());
    EXPECT_EQ(net.basin(), (std::vector<std::int64_t>{0, 0, 0}));
}

TEST(StreamNetwork, ACopyKeepsTheNumbering) {
    StreamNetwork net = nodes({{0, 0}, {1, 0}, {2, 0}, {3, 0}});
    net.add_arc(3, 2);
    net.add_arc(1, 0);
    net.add_arc(2, 1);
    StreamNetwork const copy = net;
    EXPECT_EQ(copy.from(), (std::vector<NodeId>{3, 1, 2}));
}

TEST(StreamNetwork, KindsOfNodes) {
    StreamNetwork net = nodes({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {2, 1}});
    net.add_arc(1, 0);
    net.add_arc(2, 1);
    net.add_arc(3, 2);
    net.add_arc(4, 2);
    EXPECT_EQ(std::string(name_of(kind_of(net, 0))), "outlet");
    EXPECT_EQ(std::string(name_of(kind_of(net, 1))), "pseudo");
    EXPECT_EQ(std::string(name_of(kind_of(net, 2))), "confluence");
    EXPECT_EQ(std::string(name_of(kind_of(net, 3))), "source");
}
