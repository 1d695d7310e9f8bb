// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/order/main_stems.hpp>

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <network/networks.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/network/order/order.hpp>

namespace main_stems_test {

using namespace thalweg;
using network::main_inflows;
using network::MainBy;
using network::StemClues;

namespace {

/// Two sources and the arc below: arc 0 is the longer one, arc 2 leaves to the outlet. Node 2 is the confluence.
StreamNetwork fork() {
    return test::network_of({{0.0, 300.0}, {100.0, 200.0}, {0.0, 100.0}, {0.0, 0.0}}, {{0, 2}, {1, 2}, {2, 3}});
}

ArcId chosen(StemClues const& clues, MainBy by = MainBy::file) {
    return main_inflows(fork(), clues, by)[2];
}

StemClues clues_of(StemClues::OfArc longer, StemClues::OfArc shorter, StemClues::OfArc below = {}) {
    return {{std::move(longer), std::move(shorter), std::move(below)}};
}

} // namespace

TEST(MainStems, TheLongestWithoutClues) {
    EXPECT_EQ(chosen({}), 0U);
    EXPECT_EQ(main_inflows(fork(), {}), (std::vector<ArcId>{no_arc, no_arc, 0, 2}));
    EXPECT_EQ(chosen(clues_of({}, {})), 0U);
}

TEST(MainStems, EachClueDecidesBeforeTheNext) {
    StemClues clues = clues_of({}, {.size = {2.0}});
    EXPECT_EQ(chosen(clues), 0U) << "a size that only one has tells nothing";
    clues.arcs[0].size = {1.0};
    EXPECT_EQ(chosen(clues), 1U);
    clues.arcs[0].area_m2 = 5.0;
    clues.arcs[1].area_m2 = 4.0;
    EXPECT_EQ(chosen(clues), 0U) << "areas before other sizes";
    clues.arcs[0].level = 3.0;
    clues.arcs[1].level = 2.0;
    EXPECT_EQ(chosen(clues), 1U) << "levels before areas";
    clues.arcs[0].name = clues.arcs[2].name = "Elbe";
    clues.arcs[1].name = "Saale";
    EXPECT_EQ(chosen(clues), 0U) << "names before levels";
    clues.arcs[1].path = clues.arcs[2].path = 7;
    clues.arcs[0].path = 9;
    EXPECT_EQ(chosen(clues), 1U) << "level paths before names";
}

TEST(MainStems, ByOneClueAlone) {
    StemClues const clues = clues_of({.path = 7, .level = 1.0, .name = "Saale", .area_m2 = 4.0},
                                     {.path = 9, .level = 2.0, .name = "Elbe", .area_m2 = 5.0},
                                     {.path = 7, .level = 1.0, .name = "Elbe", .area_m2 = 9.0});
    EXPECT_EQ(chosen(clues, MainBy::file), 0U);
    EXPECT_EQ(chosen(clues, MainBy::name), 1U);
    EXPECT_EQ(chosen(clues, MainBy::area), 1U);
    EXPECT_EQ(chosen(clues, MainBy::length), 0U);
    // A short river of many arcs has the greater arbolate sum.
    StreamNetwork const bushy =
        test::network_of({{0.0, 300.0}, {100.0, 120.0}, {0.0, 100.0}, {0.0, 0.0}, {200.0, 220.0}, {110.0, 260.0}},
                         {{0, 2}, {1, 2}, {2, 3}, {4, 1}, {5, 1}});
    EXPECT_EQ(main_inflows(bushy, {}, MainBy::arbolate)[2], 1U);
    EXPECT_EQ(main_inflows(bushy, {}, MainBy::length)[2], bushy.length_m(0) > 200.0 + 100.0 ? 0U : 1U);
}

TEST(MainStems, RefusesCluesOfAnotherNetwork) {
    EXPECT_NO_THROW(main_inflows(fork(), clues_of({}, {}, {})));
    StemClues two;
    two.arcs.resize(2);
    EXPECT_TRUE(test::refused("network.main_inflows", [&] { main_inflows(fork(), two); }));
    EXPECT_TRUE(test::refused("network.order", [] { network::order(fork(), {0, 1}); }));
    EXPECT_TRUE(test::refused("network.order", [] { network::order(fork(), {no_arc, no_arc, 2, 2}); }));
}

TEST(MainStems, AnyChoiceMakesOneStemAtEachNode) {
    ASSERT_TRUE(rc::check("in random forests", [] {
        StreamNetwork const net = test::any_network();
        StemClues clues;
        for (ArcId a = 0; a < net.arc_count(); ++a) {
            clues.arcs.push_back({.path = *rc::gen::inRange<std::int64_t>(0, 4),
                                  .level = static_cast<double>(*rc::gen::inRange(0, 3)),
                                  .name = std::string(1, *rc::gen::element('a', 'b')),
                                  .area_m2 = static_cast<double>(*rc::gen::inRange(0, 3))});
        }
        auto const by = *rc::gen::element(MainBy::file, MainBy::name, MainBy::area, MainBy::length, MainBy::arbolate);
        std::vector<ArcId> const main = main_inflows(net, clues, by);
        NetworkOrders const orders = network::order(net, main);
        NetworkOrders const plain = network::order(net);
        RC_ASSERT(orders.strahler == plain.strahler);
        RC_ASSERT(main_inflows(net, {}, MainBy::length) == main_inflows(net, {}));
        RC_ASSERT(network::order(net, main_inflows(net, {})).hack == plain.hack);
        for (NodeId n = 0; n < net.node_count(); ++n) {
            int const below = net.out(n) == no_arc ? 1 : orders.hack[net.out(n)];
            for (ArcId const a : net.in(n)) {
                RC_ASSERT(orders.hack[a] == below + (a == main[n] ? 0 : 1));
            }
        }
        for (std::size_t i = 0; i < orders.main_stem.size(); ++i) { // from a source to an outlet
            ArcId const a = orders.main_stem[i];
            RC_ASSERT(orders.hack[a] == 1);
            RC_ASSERT(i > 0 || net.in(net.from(a)).empty());
            RC_ASSERT(net.out(net.to(a)) == (i + 1 < orders.main_stem.size() ? orders.main_stem[i + 1] : no_arc));
        }
    }));
}

} // namespace main_stems_test
