// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/stream_network.hpp>

#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

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

} // namespace stream_network_test
