// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/error.hpp>

#include <gtest/gtest.h>

#include <thalweg/network/elevation/known_heights.hpp>

namespace keep_heights_test {

namespace {

using namespace thalweg;

/// Two sources that meet, and an outlet.
StreamNetwork two_rivers() {
    NetworkDraft net;
    NodeId const a = net.add_node({0, 4});
    NodeId const b = net.add_node({4, 4});
    NodeId const c = net.add_node({2, 2});
    NodeId const d = net.add_node({2, 0});
    net.add_arc(a, c, {{{0, 4}, {1, 3}, {2, 2}}, 1, 0, ""});
    net.add_arc(b, c, {{{4, 4}, {2, 2}}, 1, 0, ""});
    net.add_arc(c, d, {{{2, 2}, {2, 0}}, 1, 0, ""});
    return net;
}

} // namespace

TEST(KeepHeights, EmptyNetwork) {
    EXPECT_TRUE(network::keep_heights({}, {}).arc_z.empty());
}

TEST(KeepHeights, NoHeightsAtAll) {
    EXPECT_THROW(network::keep_heights(two_rivers(), {}), BadInput);
}

TEST(KeepHeights, SameNetworkKeepsItsHeights) {
    ElevatedNetwork const known{two_rivers(), {9, 8, 5, 1}, {{9, 7, 5}, {8, 5}, {5, 1}}};
    ElevatedNetwork const out = network::keep_heights(known.plan, known);
    EXPECT_EQ(out.node_z, known.node_z);
    EXPECT_EQ(out.arc_z, known.arc_z);
}

TEST(KeepHeights, AnOutletCarriedOnFallsAsItsRiverDoes) {
    ElevatedNetwork const known{two_rivers(), {9, 8, 5, 1}, {{9, 7, 5}, {8, 5}, {5, 1}}};
    NetworkDraft longer = known.plan.draft();
    ArcId const last = 2;
    longer.nodes[longer.arcs[last].to].at = {2, -10};
    longer.arcs[last].arc.line = {{2, 2}, {2, 0}, {2, -10}};
    ElevatedNetwork const out = network::keep_heights(longer, known);
    EXPECT_EQ(out.arc_z[2], (std::vector<double>{5, 1, -19})); // 2 m a metre
    EXPECT_EQ(out.node_z[3], -19);
}

TEST(KeepHeights, TheSlopeIsThatOfTheLastKilometre) {
    NetworkDraft net;
    NodeId const a = net.add_node({0, 5000});
    NodeId const b = net.add_node({0, 0});
    net.add_arc(a, b, {{{0, 5000}, {0, 1000}, {0, 500}, {0, 0}}, 1, 0, ""});
    ElevatedNetwork const known{StreamNetwork(net), {400, 0}, {{400, 2, 1.5, 0}}};
    net.nodes[b].at = {0, -500};
    net.arcs[0].arc.line.push_back({0, -500});
    ElevatedNetwork const out = network::keep_heights(StreamNetwork(net), known);
    EXPECT_EQ(out.arc_z[0], (std::vector<double>{400, 2, 1.5, 0, -1}));
}

TEST(KeepHeights, ANewArcGoesOnAsTheLowestThatComesToIt) {
    ElevatedNetwork const known{two_rivers(), {9, 8, 5, 1}, {{9, 7, 5}, {8, 5}, {5, 1}}};
    NetworkDraft longer = known.plan.draft();
    NodeId const end = longer.add_node({2, -10});
    longer.add_arc(longer.arcs[2].to, end, {{{2, 0}, {2, -10}}, 1, 0, ""});
    ElevatedNetwork const out = network::keep_heights(StreamNetwork(longer), known);
    EXPECT_EQ(out.arc_z[3], (std::vector<double>{1, -19}));
}

} // namespace keep_heights_test
