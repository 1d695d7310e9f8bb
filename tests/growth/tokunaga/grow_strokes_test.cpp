// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/growth/tokunaga/grow_strokes.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <network/networks.hpp>
#include <rapidcheck/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/geometry/nearby.hpp>
#include <thalweg/growth/tokunaga/internal/grow_strokes.hpp>
#include <thalweg/network/order/order.hpp>

namespace grow_strokes_test {

using namespace thalweg;
using growth::grow_strokes;
using growth::GrownStrokes;
using growth::StrokesParams;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// 200 x 200 cells of 10 m, the south-west corner in (0, 0).
Grid const grid{200, 200, 10.0, 0.0, 2000.0, "EPSG:32631"};

RiverLine stroke(std::int64_t feature, std::vector<Vec2> const& line, std::string const& type = "B", int lambda = 2) {
    RiverLine out;
    out.feature = feature;
    for (Vec2 const p : line) {
        out.vertices.push_back({p.x, p.y, unknown});
    }
    out.type = type;
    out.lambda = lambda;
    return out;
}

RiverLines drawn(std::vector<RiverLine> lines) {
    return {std::move(lines), "EPSG:32631", "hand.geojson", false};
}

/// Shallow trees, so that many can be grown.
StrokesParams shallow() {
    StrokesParams params;
    params.max_depth = 3;
    return params;
}

double off(RiverLine const& line, Vec2 p) {
    double least = infinite;
    for (std::size_t i = 0; i + 1 < line.vertices.size(); ++i) {
        Vec2 const a{line.vertices[i].x, line.vertices[i].y};
        Vec2 const b{line.vertices[i + 1].x, line.vertices[i + 1].y};
        least = std::min(least, distance(p, geometry::foot_on(a, b, p).at));
    }
    return least;
}

Vec2 start_of(RiverLine const& line) {
    return {line.vertices.front().x, line.vertices.front().y};
}

/// The stroke on which another begins, within half a cell, or none.
RiverLine const* below(RiverLines const& strokes, std::size_t k) {
    for (std::size_t other = 0; other < strokes.lines.size(); ++other) {
        if (other != k && off(strokes.lines[other], start_of(strokes.lines[k])) <= 0.5 * grid.cell_m) {
            return &strokes.lines[other];
        }
    }
    return nullptr;
}

/// The law that a network breaks, or "".
std::string broken(RiverLines const& strokes, GrownStrokes const& grown) {
    std::map<std::int64_t, std::size_t> number;
    for (std::size_t k = 0; k < strokes.lines.size(); ++k) {
        number[strokes.lines[k].feature] = k;
    }
    for (ArcId arc = 0; arc < grown.network.arc_count(); ++arc) {
        Arc const& here = grown.network.arc(arc);
        if (number.count(here.feature) == 0 || here.type != strokes.lines[number[here.feature]].type) {
            return "an arc has the type or the feature of no stroke";
        }
        for (Vec2 const p : here.line) {
            if (!(p.x >= grid.west && p.x <= grid.east() && p.y >= grid.south() && p.y <= grid.north)) {
                return "an arc leaves the grid";
            }
        }
    }
    if (!test::meetings_of(grown.network).empty()) {
        return "arcs meet outside of nodes";
    }
    for (NodeId n = 0; n < grown.network.node_count(); ++n) {
        if (grown.network.out_arcs(n).size() > 1 || grown.network.basin(n) == 0) {
            return "a node without one way to an outlet";
        }
    }
    if (grown.network.node_count() != grown.network.arc_count() + grown.network.outlets().size()) {
        return "a basin is no tree";
    }
    std::set<std::pair<double, double>> mouths;
    for (std::size_t k = 0; k < strokes.lines.size(); ++k) {
        if (below(strokes, k) == nullptr) {
            mouths.insert({start_of(strokes.lines[k]).x, start_of(strokes.lines[k]).y});
        }
    }
    for (NodeId const n : grown.network.outlets()) {
        if (mouths.erase({grown.network.node(n).at.x, grown.network.node(n).at.y}) == 0) {
            return "an outlet is no stroke's mouth, or twice one's";
        }
    }
    return "";
}

/// Whether the arcs of a stroke that begins on another flow into others' where it does.
bool joins(RiverLines const& strokes, std::size_t k, GrownStrokes const& grown, double within_m) {
    for (NodeId n = 0; n < grown.network.node_count(); ++n) {
        if (distance(grown.network.node(n).at, start_of(strokes.lines[k])) > within_m ||
            grown.network.out(n) == no_arc) {
            continue;
        }
        auto const feature = [&](std::int64_t arc) { return grown.network.arc(arc).feature; };
        std::int64_t const own = strokes.lines[k].feature;
        bool const arrives = std::any_of(grown.network.in(n).begin(), grown.network.in(n).end(),
                                         [&](std::int64_t arc) { return feature(arc) == own; });
        if (arrives && grown.network.in(n).size() > 1 && feature(grown.network.out(n)) != own) {
            return true;
        }
    }
    return false;
}

/// Places of the main stem: from the outlet always up the arc of the highest order, while it is that of the outlet.
std::vector<Vec2> trunk(StreamNetwork const& net, NodeId outlet) {
    NetworkOrders const orders = network::order(net);
    std::vector<Vec2> places;
    std::int64_t arc = net.in(outlet).front();
    int const top = orders.strahler[static_cast<std::size_t>(arc)];
    while (arc >= 0) {
        auto const& line = net.arc(arc).line;
        places.insert(places.end(), line.rbegin(), line.rend());
        std::int64_t next = -1;
        for (ArcId const up : net.in(net.from(arc))) {
            next = orders.strahler[up] == top ? up : next;
        }
        arc = next;
    }
    return places;
}

} // namespace

TEST(GrowStrokes, NoStrokesNoRivers) {
    GrownStrokes const grown = grow_strokes(drawn({}), grid);
    EXPECT_EQ(grown.network.node_count(), 0U);
    EXPECT_EQ(grown.placed, 0);
    EXPECT_EQ(grown.dropped, 0);
}

TEST(GrowStrokes, RefusesStrokesThatAreNoRiversWithTheirPlace) {
    RiverLine const up = stroke(1, {{1000.0, 100.0}, {1000.0, 900.0}});
    RiverLine const branch = stroke(2, {{1000.0, 500.0}, {1400.0, 600.0}});
    auto const with = [&](std::vector<Vec2> const& line) { return std::vector{up, stroke(2, line)}; };
    std::vector<Vec2> const loop{{500.0, 500.0}, {900.0, 500.0}, {900.0, 700.0}, {700.0, 300.0}};
    for (auto const& [strokes, words] : std::vector<std::pair<std::vector<RiverLine>, std::string>>{
             {{up, stroke(7, {})}, "stroke 7 of hand.geojson at (0.000, 0.000) is a"},
             {{up, stroke(7, {{300.0, 400.0}})}, "stroke 7 of hand.geojson at (300.000, 400.000) is a"},
             {{stroke(7, {{300.0, 400.0}, {300.0, 400.0}}), up}, "stroke 7 of hand.geojson at (300"},
             {{up, stroke(8, {{300.0, 400.0}, {2000.5, 400.0}})}, "stroke 8 of hand.geojson at (2000.500, 400.000)"},
             {{stroke(8, {{300.0, 400.0}, {unknown, 400.0}, {500.0, 400.0}})}, "leaves the grid"},
             {{up, stroke(9, {{300.0, 400.0}, {400.0, 400.0}}, "Aaa+")}, "Did you mean 'Aa+'?"},
             {{up, stroke(9, {{998.0, 400.0}, {1001.0, 400.0}, {1000.0, 400.0}})}, "stroke 9"},
             {{up, stroke(9, {{1004.0, 400.0}, {1000.0, 400.0}})}, "(1000.000, 400.000) is no longer than half a cell"},
             {with({{500.0, 300.0}, {1500.0, 500.0}}), "(1000.000, 400.000) crosses stroke 2"},
             {with({{500.0, 300.0}, {1000.0, 500.0}}), "stroke 2 of hand.geojson at (1000.000, 500.000) ends on"},
             {with({{500.0, 300.0}, {996.0, 500.0}}), "ends on stroke 1"},
             {with({{500.0, 300.0}, {1000.0, 900.0}}), "(1000.000, 900.000) ends on stroke 2"},
             {with({{1000.0, 104.0}, {1500.0, 500.0}}), "(1000.000, 104.000) begins where stroke 1 does"},
             {with({{1000.0, 897.0}, {1500.0, 1500.0}}), "(1000.000, 897.000) begins at the upper end of stroke 1"},
             {with({{1000.0, 300.0}, {1300.0, 300.0}, {900.0, 600.0}}), "(1000.000, 525.000) crosses stroke 2"},
             {with({{1000.0, 300.0}, {1000.0, 500.0}, {1200.0, 600.0}}), "crosses stroke 2"}, // runs along it
             {{up, branch, stroke(3, {{1003.0, 500.0}, {600.0, 600.0}})}, "(1003.000, 500.000) begins where stroke 2"},
             // The third crosses where the second begins.
             {{up, branch, stroke(3, {{800.0, 400.0}, {1200.0, 600.0}})}, "at (1000.000, 500.000) crosses stroke 3"},
             {{stroke(4, loop)}, "stroke 4 of hand.geojson at (800.000, 500.000) meets itself"},
             {{stroke(4, {{500.0, 500.0}, {900.0, 500.0}, {600.0, 500.0}})}, "meets itself"},
             {{stroke(4, {{500.0, 500.0}, {900.0, 500.0}, {900.0, 800.0}, {500.0, 500.0}})},
              "(500.000, 500.000) meets itself"},
             // Another begins in the loop's knot.
             {{stroke(4, loop), stroke(5, {{800.0, 500.0}, {780.0, 900.0}})}, "meets itself"},
             {{stroke(1, {{100.0, 500.0}, {900.0, 500.0}}),
               stroke(2, {{500.0, 500.0}, {500.0, 200.0}, {100.0, 200.0}, {100.0, 800.0}})},
              "stroke 1 of hand.geojson at (100.000, 500.000) flows in a ring of strokes"},
             {{stroke(3, {{1500.0, 1000.0}, {1500.0, 1900.0}}), // not in the ring, but above it
               stroke(1, {{100.0, 500.0}, {900.0, 500.0}}), stroke(2, {{500.0, 500.0}, {500.0, 900.0}}),
               stroke(4, {{500.0, 700.0}, {100.0, 700.0}, {100.0, 300.0}})},
              "flows in a ring of strokes"},
             // Its river would run through the other limb of a hairpin.
             {{stroke(10, {{150.0, 250.0}, {175.0, 160.0}, {112.0, 307.0}}),
               stroke(11, {{157.0, 212.0}, {74.0, 113.0}, {0.0, 0.0}}), stroke(14, {{144.7, 198.1}, {0.0, 28.1}})},
              "stroke 14 of hand.geojson at (144.700, 198.100) begins on stroke 11"}}) {
        auto const act = [&] { grow_strokes(drawn(strokes), grid, shallow()); };
        EXPECT_TRUE(test::refused("growth.grow_strokes", act, words));
    }
}

TEST(GrowStrokes, NumbersOutOfRangeAreRefused) {
    RiverLines const one = drawn({stroke(1, {{1000.0, 100.0}, {1000.0, 900.0}}, "B", 0)});
    for (StrokesParams const& wrong : std::vector<StrokesParams>{{.tree = {}, .max_depth = 0},
                                                                 {.tree = {}, .max_depth = 30},
                                                                 {.tree = {}, .reach = 0.0},
                                                                 {.tree = {}, .reach = 2.001},
                                                                 {.tree = {}, .reach = unknown},
                                                                 {.tree = {}, .clearance = 0.04},
                                                                 {.tree = {}, .clearance = 0.36},
                                                                 {.tree = {}, .clearance = unknown},
                                                                 {.tree = {}, .min_spacing_m = -1.0},
                                                                 {.tree = {}, .min_spacing_m = unknown},
                                                                 {.tree = {}, .min_spacing_m = infinite}}) {
        EXPECT_TRUE(test::refused<BadParameter>("growth.grow_strokes", [&] { grow_strokes(one, grid, wrong); }));
    }
    StrokesParams params;
    params.tree.generator = 51;
    EXPECT_THROW(grow_strokes(one, grid, params), BadParameter);
}

TEST(GrowStrokes, RefinementsFollowFromTheLength) {
    StrokesParams params;
    params.max_depth = 4;
    for (auto const& [length, depth] : std::vector<std::pair<double, int>>{
             {30.0, 1}, {200.0, 1}, {700.0, 1}, {749.9, 1}, {750.1, 2}, {1200.0, 2}, {1260.0, 3}, {1740.0, 3}}) {
        GrownStrokes const grown =
            grow_strokes(drawn({stroke(1, {{1000.0, 100.0}, {1000.0, 100.0 + length}})}), grid, params);
        NetworkOrders const orders = network::order(grown.network);
        ASSERT_FALSE(orders.strahler.empty());
        EXPECT_EQ(*std::max_element(orders.strahler.begin(), orders.strahler.end()), depth + 1) << length;
    }
    // Longer than the grid is wide: no more than asked.
    GrownStrokes const grown =
        grow_strokes(drawn({stroke(1, {{100.0, 100.0}, {1900.0, 400.0}, {1900.0, 1900.0}})}), grid, params);
    NetworkOrders const orders = network::order(grown.network);
    EXPECT_EQ(*std::max_element(orders.strahler.begin(), orders.strahler.end()), 5);
}

TEST(GrowStrokes, TheGeneratorIsThatOfTheStrokeOrElseThatOfAll) {
    StrokesParams params = shallow();
    params.tree.generator = 5;
    for (int const lambda : {0, 1, 2, 3, 9}) {
        GrownStrokes const grown =
            grow_strokes(drawn({stroke(1, {{1000.0, 100.0}, {1000.0, 700.0}}, "B", lambda)}), grid, params);
        EXPECT_EQ(grown.placed + grown.dropped, 2 * (lambda == 0 ? 5 : lambda) + 1) << lambda;
    }
}

TEST(GrowStrokes, TheTrunkFollowsTheStroke) {
    for (std::vector<Vec2> const& line :
         std::vector<std::vector<Vec2>>{{{1000.0, 0.0}, {1000.0, 1900.0}},
                                        {{100.0, 300.0}, {700.0, 500.0}, {1200.0, 400.0}, {1800.0, 900.0}},
                                        {{1900.0, 1900.0}, {1500.0, 1300.0}, {1400.0, 700.0}, {800.0, 500.0}}}) {
        RiverLines const strokes = drawn({stroke(1, line, "C")});
        StrokesParams params;
        params.max_depth = 5;
        GrownStrokes const grown = grow_strokes(strokes, grid, params);
        EXPECT_EQ(broken(strokes, grown), "");
        ASSERT_EQ(grown.network.outlets().size(), 1U);
        std::vector<Vec2> const places = trunk(grown.network, grown.network.outlets().front());
        EXPECT_GT(places.size(), 15U);
        for (Vec2 const p : places) {
            EXPECT_LE(off(strokes.lines.front(), p), 1e-3) << p.x << " " << p.y;
        }
        EXPECT_GE(static_cast<double>(grown.placed), 0.95 * static_cast<double>(grown.placed + grown.dropped));
    }
}

TEST(GrowStrokes, OneThatBeginsOnAnotherFlowsIntoIt) {
    RiverLines const strokes = drawn(
        {stroke(3, {{1004.0, 700.0}, {1500.0, 1000.0}}, "A", 3), stroke(1, {{1000.0, 0.0}, {1000.0, 1500.0}}, "B"),
         stroke(2, {{997.0, 1000.0}, {300.0, 1400.0}}, "Aa+", 1), stroke(4, {{1300.0, 881.0}, {1250.0, 1300.0}}, "A")});
    GrownStrokes const grown = grow_strokes(strokes, grid);
    EXPECT_EQ(broken(strokes, grown), "");
    ASSERT_EQ(grown.network.outlets().size(), 1U);
    for (std::size_t const k : {0U, 2U, 3U}) {
        EXPECT_TRUE(joins(strokes, k, grown, 0.5 * grid.cell_m)) << strokes.lines[k].feature;
    }
    EXPECT_GE(static_cast<double>(grown.placed), 0.95 * static_cast<double>(grown.placed + grown.dropped));
    // The same mouths and ends in any order of the file.
    RiverLines turned = strokes;
    std::reverse(turned.lines.begin(), turned.lines.end());
    GrownStrokes const again = grow_strokes(turned, grid);
    EXPECT_EQ(broken(turned, again), "");
    EXPECT_EQ(again.network.outlets().size(), 1U);
}

TEST(GrowStrokes, BothSidesOfATrunkAreFilledAsTheyAreLarge) {
    // A trunk in the middle, one near the west edge, and one near the east.
    for (double const x : {1000.0, 300.0, 1700.0}) {
        RiverLines const strokes = drawn({stroke(1, {{x, 100.0}, {x, 1900.0}})});
        std::vector<growth::Stroke> const read = growth::join_strokes(strokes, grid);
        double const left = growth::StrokeLands(read, grid, 0.35).share_left(0);
        EXPECT_NEAR(left, x == 1000.0 ? 0.5 : x == 300.0 ? 300.0 / 865.0 : 565.0 / 865.0, 0.04);
        for (std::uint64_t seed = 1; seed <= 5; ++seed) {
            StrokesParams params;
            params.max_depth = 4;
            params.tree.seed = seed;
            GrownStrokes const grown = grow_strokes(strokes, grid, params);
            double west = 0.0;
            double all = 0.0;
            for (ArcId arc = 0; arc < grown.network.arc_count(); ++arc) {
                auto const& line = grown.network.arc(arc).line;
                for (std::size_t i = 0; i + 1 < line.size(); ++i) {
                    double const middle = 0.5 * (line[i].x + line[i + 1].x);
                    double const length = distance(line[i], line[i + 1]);
                    all += std::fabs(middle - x) > 1e-3 ? length : 0.0;
                    west += middle < x - 1e-3 ? length : 0.0;
                }
            }
            EXPECT_NEAR(west / all, left, x == 1000.0 ? 0.12 : 0.2) << x << " seed " << seed;
        }
    }
}

TEST(GrowStrokes, IsTheSameForTheSameSeedOnly) {
    RiverLines const strokes = drawn(
        {stroke(1, {{1000.0, 0.0}, {1000.0, 1500.0}}, "B", 3), stroke(2, {{1000.0, 700.0}, {1600.0, 1200.0}}, "A", 4)});
    StrokesParams params = shallow();
    GrownStrokes const seven = grow_strokes(strokes, grid, params);
    EXPECT_TRUE(test::same_network(seven.network, grow_strokes(strokes, grid, params).network));
    params.tree.seed = 8;
    EXPECT_FALSE(test::same_network(seven.network, grow_strokes(strokes, grid, params).network));
}

TEST(GrowStrokes, WhatIsDrawnStaysWhereItIsAlongTheEdgeToo) {
    RiverLines const strokes =
        drawn({stroke(10, {{153.0, 275.0}, {116.0, 266.0}}), stroke(11, {{132.8, 266.6}, {0.0, 167.6}, {0.0, 0.0}}),
               stroke(12, {{136.2, 270.4}, {0.0, 272.4}}), stroke(14, {{36.9, 267.8}, {0.0, 174.8}})});
    for (int depth = 1; depth < 6; ++depth) {
        StrokesParams params = shallow();
        params.max_depth = depth;
        GrownStrokes const grown = grow_strokes(strokes, grid, params);
        EXPECT_EQ(broken(strokes, grown), "");
        for (std::size_t k = 1; k < strokes.lines.size(); ++k) {
            EXPECT_TRUE(joins(strokes, k, grown, grid.cell_m)) << strokes.lines[k].feature << " at depth " << depth;
        }
    }
}

TEST(GrowStrokes, ListensToAStop) {
    RiverLines const one = drawn({stroke(1, {{1000.0, 0.0}, {1000.0, 1500.0}})});
    EXPECT_THROW(grow_strokes(one, grid, {}, test::stopped_run()), Cancelled);
}

TEST(BalanceBanks, RefusesWhatIsNoShare) {
    growth::TokunagaTree tree = growth::grow_tokunaga({.order = 3});
    for (double const wrong : {-0.01, 1.01, unknown}) {
        EXPECT_THROW(growth::balance_banks(tree, wrong), BadParameter);
    }
}

RC_GTEST_PROP(BalanceBanks, GivesEachSideItsShareOfTheLinks, ()) {
    int const lambda = *rc::gen::inRange(1, 8);
    int const order = *rc::gen::inRange(1, 6);
    auto const seed = *rc::gen::arbitrary<std::uint64_t>();
    double const share = *rc::gen::inRange(0, 101) / 100.0;
    growth::TokunagaTree const before = growth::grow_tokunaga({.seed = seed, .generator = lambda, .order = order});
    growth::TokunagaTree tree = before;
    growth::balance_banks(tree, share);
    RC_ASSERT(tree.links.size() == before.links.size());
    std::vector<std::size_t> const trunk = growth::trunk_of(tree);
    std::set<std::size_t> const main(trunk.begin(), trunk.end());
    std::vector<double> links(tree.links.size(), 1.0); // that flow through each
    for (std::size_t i = tree.links.size(); i-- > 1;) {
        links[static_cast<std::size_t>(tree.links[i].down)] += links[i];
    }
    double side[2] = {};
    double largest = 0.0;
    for (std::size_t i = 0; i < tree.links.size(); ++i) {
        auto const& link = tree.links[i];
        bool const branch =
            link.down >= 0 && main.count(static_cast<std::size_t>(link.down)) != 0 && main.count(i) == 0;
        RC_ASSERT((branch || link.turn == before.links[i].turn));
        RC_ASSERT(std::abs(link.turn) == std::abs(before.links[i].turn));
        if (branch) {
            side[link.turn > 0 ? 0 : 1] += links[i];
            largest = std::max(largest, links[i]);
        }
    }
    RC_ASSERT(std::fabs(side[0] - share * (side[0] + side[1])) <= largest);
}

RC_GTEST_PROP(GrowStrokes, KeepsEveryLawOrSaysWhereItCannot, ()) {
    auto const count = *rc::gen::inRange<std::size_t>(2, 7);
    std::vector<RiverLine> lines;
    auto const near = [](Vec2 p, int reach) {
        auto const moved = [reach](double v) {
            return std::clamp(v + *rc::gen::inRange(-reach, reach + 1), 0.0, 2000.0);
        };
        double const x = moved(p.x);
        return Vec2{x, moved(p.y)};
    };
    for (std::size_t k = 0; k < count; ++k) {
        std::vector<Vec2> line{near({400.0 + 600.0 * static_cast<double>(k % 3), k < 3 ? 500.0 : 1500.0}, 250)};
        if (k > 0 && *rc::gen::inRange(0, 3) == 0) { // on another, about
            auto const& onto = lines[*rc::gen::inRange<std::size_t>(0, k)].vertices;
            Vec3 const a = onto[0];
            Vec3 const b = onto[1];
            double const share = *rc::gen::inRange(0, 11) / 10.0;
            line.front() = near({a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)}, 4);
        }
        auto const more = *rc::gen::inRange(1, 4);
        for (int i = 0; i < more; ++i) {
            line.push_back(near(line.back(), 200));
        }
        lines.push_back(stroke(static_cast<std::int64_t>(10 + k), line, *rc::gen::element<std::string>("", "A", "DA"),
                               *rc::gen::inRange(0, 5)));
    }
    RiverLines const strokes = drawn(std::move(lines));
    StrokesParams params = shallow();
    params.max_depth = *rc::gen::inRange(1, 8);
    params.tree.seed = *rc::gen::arbitrary<std::uint64_t>();
    GrownStrokes grown;
    try {
        grown = grow_strokes(strokes, grid, params);
    } catch (BadInput const& e) {
        RC_TAG("refused");
        RC_ASSERT(std::string(e.what()).find("stroke 1") != std::string::npos);
        RC_ASSERT(std::string(e.what()).find(" of hand.geojson at (") != std::string::npos);
        return;
    }
    RC_TAG("grown");
    RC_ASSERT(broken(strokes, grown) == "");
    RC_ASSERT(test::same_network(grown.network, grow_strokes(strokes, grid, params).network));
    std::set<std::int64_t> features;
    for (ArcId arc = 0; arc < grown.network.arc_count(); ++arc) {
        features.insert(grown.network.arc(arc).feature);
    }
    for (std::size_t k = 0; k < strokes.lines.size(); ++k) {
        if (below(strokes, k) != nullptr && features.count(strokes.lines[k].feature) != 0) {
            RC_ASSERT(joins(strokes, k, grown, grid.cell_m)); // the other may have been moved by as much
        }
    }
}

} // namespace grow_strokes_test
