// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/line_sources.hpp>

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>
#include <network/networks.hpp>
#include <rapidcheck.h>

#include <thalweg/network/planform/carry_outlets.hpp>
#include <thalweg/network/planform/meander.hpp>
#include <thalweg/network/planform/split_confluences.hpp>

namespace line_sources_test {

using namespace thalweg;
using make::LineSources;

namespace {

using Stretches = std::vector<std::vector<Stretch>>;

/// Each arc in stretches that change at vertices; features are numbered from 1 through all arcs, and each arc has the
/// feature of its first.
Stretches stretches_in(StreamNetwork& network, std::uint64_t seed) {
    Stretches result;
    std::int64_t feature = 0;
    std::uint64_t place = 0;
    NetworkDraft named = network.draft();
    for (DraftArc& drawn : named.arcs) {
        auto const& line = drawn.arc.line;
        drawn.arc.feature = feature + 1;
        std::vector<Stretch> own;
        double along_m = 0.0;
        for (std::size_t i = 1; i < line.size(); ++i) {
            if (own.empty() || unit(random_word(seed, place++)) < 0.4) {
                own.push_back({++feature, along_m, along_m});
            }
            along_m += distance(line[i - 1], line[i]);
            own.back().to_m = along_m;
        }
        result.push_back(own);
    }
    network = std::move(named);
    return result;
}

/// Law: sorted, without gaps, from one end of the arc to the other.
void expect_covered(StreamNetwork const& network, Stretches const& stretches) {
    ASSERT_EQ(stretches.size(), network.arc_count());
    for (std::size_t a = 0; a < stretches.size(); ++a) {
        ASSERT_FALSE(stretches[a].empty()) << "arc " << a + 1;
        EXPECT_EQ(stretches[a].front().from_m, 0.0);
        EXPECT_NEAR(stretches[a].back().to_m, network.length_m(a), 1e-9 * network.length_m(a));
        for (std::size_t k = 0; k < stretches[a].size(); ++k) {
            Stretch const& s = stretches[a][k];
            EXPECT_GT(s.feature, 0);
            EXPECT_LT(s.from_m, s.to_m) << "arc " << a + 1;
            EXPECT_TRUE(k == 0 || stretches[a][k - 1].to_m == s.from_m) << "arc " << a + 1;
            EXPECT_TRUE(k == 0 || stretches[a][k - 1].feature != s.feature) << "arc " << a + 1;
        }
    }
}

void expect_same(Stretches const& is, Stretches const& was) {
    ASSERT_EQ(is.size(), was.size());
    for (std::size_t a = 0; a < is.size(); ++a) {
        ASSERT_EQ(is[a].size(), was[a].size()) << "arc " << a + 1;
        for (std::size_t k = 0; k < is[a].size(); ++k) {
            EXPECT_EQ(is[a][k].feature, was[a][k].feature);
            EXPECT_DOUBLE_EQ(is[a][k].from_m, was[a][k].from_m);
            EXPECT_DOUBLE_EQ(is[a][k].to_m, was[a][k].to_m);
        }
    }
}

/// A river from north to south, 1000 m between its nodes, into each of which several tributaries of many vertices run.
ElevatedNetwork fans(std::uint64_t seed, std::size_t nodes, std::size_t most) {
    RandomStream words(seed, 7, 0);
    std::vector<Vec2> at{{0.0, 1000.0 * static_cast<double>(nodes)}};
    std::vector<double> z{10.0 * static_cast<double>(nodes)};
    std::vector<test::Reach> reaches;
    auto const reach = [&](std::size_t from, std::size_t to) {
        test::Reach& drawn = reaches.emplace_back(test::Reach{from, to});
        std::uint64_t const segments = 1 + words.word() % 8;
        for (std::uint64_t i = 1; i < segments; ++i) {
            double const share = static_cast<double>(i) / static_cast<double>(segments);
            drawn.between.push_back(at[from] + share * (at[to] - at[from]));
        }
    };
    std::size_t above = 0;
    for (std::size_t k = nodes; k-- > 0;) {
        auto const row = static_cast<double>(k);
        std::size_t const here = at.size();
        at.push_back({0.0, 1000.0 * row});
        z.push_back(10.0 * row);
        reach(above, here);
        std::size_t const tributaries = k == 0 ? 0 : words.word() % (most + 1);
        for (std::size_t t = 0; t < tributaries; ++t) {
            double const share = (static_cast<double>(t) + 1.0) / (static_cast<double>(tributaries) + 1.0);
            at.push_back({400.0 * (2.0 * share - 1.0) + 7.0, 1000.0 * row + 700.0});
            z.push_back(10.0 * row + 5.0);
            reach(at.size() - 1, here);
        }
        above = here;
    }
    return test::elevated(test::network_of(at, reaches), z);
}

} // namespace

TEST(LineSources, StretchesThatAreGoneAreFound) {
    StreamNetwork const before =
        test::network_of({{0, 40}, {40, 40}, {0, 20}, {0, 0}},
                         {{.from = 0, .to = 2, .between = {{0, 30}}, .feature = 1}, {1, 2, {}, 2}, {2, 3, {}, 3}});
    LineSources const sources(before, {{{1, 0.0, 20.0}}, {{2, 0.0, 44.72}}, {{3, 0.0, 20.0}}});
    auto const gone = [&](StreamNetwork const& after) {
        std::map<std::int64_t, std::vector<Vec2>> result;
        for (SecondaryLine const& line : sources.missing(before, after, LeftOut::head, "cut")) {
            EXPECT_EQ(line.record, line.feature);
            EXPECT_EQ(line.cause, LeftOut::head);
            EXPECT_EQ(line.reason, "cut");
            for (Vec3 const v : line.vertices) {
                result[line.feature].push_back(in_plan(v));
            }
        }
        return result;
    };
    using Gone = std::map<std::int64_t, std::vector<Vec2>>;
    EXPECT_EQ(gone(before), Gone{});
    // One begins farther down, within a segment; the other is gone; a side valley has come in between two vertices.
    EXPECT_EQ(gone(test::network_of({{0, 36}, {0, 0}, {0, 9}, {50, 9}},
                                    {{0, 2, {{0, 30}, {0, 20}}, 1}, {2, 1, {}, 3}, {3, 2, {}, 0}})),
              (Gone{{1, {{0, 40}, {0, 36}}}, {2, {{40, 40}, {0, 20}}}}));
    EXPECT_EQ(gone(test::network_of({{0, 30}, {0, 0}}, {{0, 1, {{0, 20}}, 1}})),
              (Gone{{1, {{0, 40}, {0, 30}}}, {2, {{40, 40}, {0, 20}}}}));
    EXPECT_EQ(gone(StreamNetwork()),
              (Gone{{1, {{0, 40}, {0, 30}, {0, 20}}}, {2, {{40, 40}, {0, 20}}}, {3, {{0, 20}, {0, 0}}}}));
}

TEST(LineSources, NothingIsKnownOfGrownRivers) {
    StreamNetwork const none;
    EXPECT_FALSE(LineSources().knows_any());
    EXPECT_TRUE(LineSources().of(none).empty());
    StreamNetwork net = test::network_of({{0, 10}, {0, 0}}, {{0, 1}});
    expect_same(LineSources().of(net), {{}});
    LineSources const bent = LineSources().bent(net, net);
    EXPECT_FALSE(bent.knows_any());
    expect_same(bent.of(net), {{}});
}

TEST(LineSources, ArcsThatStayHaveTheirStretches) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        StreamNetwork net = fans(seed, 4, 4).planform;
        Stretches const drawn = stretches_in(net, seed);
        LineSources const sources(net, drawn);
        EXPECT_TRUE(sources.knows_any());
        expect_same(sources.of(net), drawn);
        expect_same(sources.redrawn(net), drawn);
    }
}

TEST(LineSources, JoinedAndShortenedArcs) {
    // Features 1 and 2 meet at (0, 20); 3 joins there.
    StreamNetwork const net = test::network_of(
        {{0, 40}, {0, 20}, {30, 20}, {0, 0}},
        {{.from = 0, .to = 1, .between = {{0, 30}}, .feature = 1}, {1, 3, {{0, 10}}, 2}, {2, 1, {{15, 20}}, 3}});
    LineSources const sources(net, {{{1, 0.0, 20.0}}, {{2, 0.0, 20.0}}, {{3, 0.0, 30.0}}});
    // Without the tributary the arcs are one.
    StreamNetwork const joined = test::network_of({{0, 40}, {0, 0}}, {{0, 1, {{0, 30}, {0, 20}, {0, 10}}, 1}});
    expect_same(sources.of(joined), {{{1, 0.0, 20.0}, {2, 20.0, 40.0}}});
    // Of the upper reach the lower half of a segment is left.
    StreamNetwork const shorter = test::network_of({{0, 35}, {0, 20}}, {{0, 1, {{0, 30}}, 1}});
    expect_same(sources.of(shorter), {{{1, 0.0, 15.0}}});
    // Where several rivers arrive, what is left of one is known by its arc's feature.
    StreamNetwork const stub = test::network_of({{0, 25}, {0, 20}}, {{0, 1, {}, 1}});
    expect_same(sources.of(stub), {{{1, 0.0, 5.0}}});
}

TEST(LineSources, WhatIsDrawnBeyondTheFileIsInNoStretch) {
    StreamNetwork net = test::network_of({{50, 90}, {50, 50}}, {{0, 1, {{50, 70}}, 1}});
    LineSources const sources(net, {{{1, 0.0, 40.0}}});
    network::CarriedNetwork const carried = network::carry_outlets(net, Grid{20, 20, 5.0, 0.0, 100.0, "EPSG:32631"});
    ASSERT_GT(carried.network.length_m(0), 50.0);
    expect_same(sources.of(carried.network), {{{1, 0.0, 40.0}}});
    // Nor when confluences are split afterwards.
    LineSources const later(carried.network, sources.of(carried.network));
    expect_same(later.redrawn(carried.network), {{{1, 0.0, 40.0}}});
}

// Law: stretches cover a bent arc as they covered the straight one; each end moves by one segment at most.
TEST(LineSources, MeanderedRiversAreCovered) {
    ASSERT_TRUE(rc::check([] {
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1000);
        StreamNetwork net = fans(seed, 4, 2).planform;
        Stretches const drawn = stretches_in(net, seed);
        Grid const grid{100, 480, 10.0, -500.0, 4400.0, "EPSG:32631"};
        std::vector<double> const area_m2(net.arc_count(), 1e6);
        network::MeanderedNetwork const bent = network::meander(net, grid, area_m2, {.gain = 2.0, .seed = seed});
        RC_PRE(bent.vertices > 0);
        LineSources const sources = LineSources(net, drawn).bent(net, bent.network);
        Stretches const is = sources.of(bent.network);
        expect_covered(bent.network, is);
        RC_ASSERT(!testing::Test::HasFailure());
        for (std::size_t a = 0; a < is.size(); ++a) {
            double longest_m = 0.0;
            auto const& line = bent.network.arc(a).line;
            for (std::size_t i = 1; i < line.size(); ++i) {
                longest_m = std::max(longest_m, distance(line[i - 1], line[i]));
            }
            double const share = bent.network.length_m(a) / net.length_m(a);
            for (Stretch const& s : is[a]) {
                auto const old = std::ranges::find(drawn[a], s.feature, &Stretch::feature);
                RC_ASSERT(old != drawn[a].end());
                RC_ASSERT(std::fabs(s.from_m - share * old->from_m) <= longest_m);
                RC_ASSERT(std::fabs(s.to_m - share * old->to_m) <= longest_m);
            }
        }
    }));
}

// Law: where confluences are split, arcs and the pieces cut off them are covered by features of the arc that was there,
// and what kept its place keeps its feature.
TEST(LineSources, SplitConfluencesAreCovered) {
    ASSERT_TRUE(rc::check([] {
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1000);
        ElevatedNetwork rivers = fans(seed, 4, 5);
        Stretches const drawn = stretches_in(rivers.planform, seed);
        std::map<std::int64_t, std::size_t> arc_of;
        std::map<std::pair<double, double>, std::int64_t> leaving; // features by place
        for (std::size_t a = 0; a < drawn.size(); ++a) {
            double along_m = 0.0;
            auto const& line = rivers.planform.arc(a).line;
            for (std::size_t i = 0; i + 1 < line.size(); ++i) {
                auto const at = std::ranges::find_if(
                    drawn[a], [&](Stretch const& s) { return along_m >= s.from_m && along_m < s.to_m; });
                leaving[{line[i].x, line[i].y}] = at->feature;
                along_m += distance(line[i], line[i + 1]);
            }
            for (Stretch const& s : drawn[a]) {
                arc_of[s.feature] = a;
            }
        }
        network::Split const split = network::split_confluences(rivers, {2, 30.0});
        RC_CLASSIFY(split.pieces.empty());
        Stretches const is = LineSources(rivers.planform, drawn).redrawn(split.network.planform);
        expect_covered(split.network.planform, is);
        RC_ASSERT(!testing::Test::HasFailure());
        for (std::size_t a = 0; a < is.size(); ++a) {
            std::size_t first = a;
            while (first >= drawn.size()) {
                first = split.pieces[first - drawn.size()].of;
            }
            for (Stretch const& s : is[a]) {
                RC_ASSERT(arc_of.at(s.feature) == first);
            }
            double along_m = 0.0;
            auto const& line = split.network.planform.arc(a).line;
            for (std::size_t i = 0; i + 1 < line.size(); ++i) {
                if (auto const known = leaving.find({line[i].x, line[i].y}); known != leaving.end()) {
                    auto const at = std::ranges::find_if(
                        is[a], [&](Stretch const& s) { return along_m >= s.from_m - 1e-6 && along_m < s.to_m - 1e-6; });
                    RC_ASSERT(at != is[a].end());
                    RC_ASSERT(at->feature == known->second);
                }
                along_m += distance(line[i], line[i + 1]);
            }
        }
    }));
}

} // namespace line_sources_test
