// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Where water could go more than one way, import_lines keeps the main path.
#include <thalweg/network/import/import_lines.hpp>

#include <algorithm>
#include <set>

#include <gtest/gtest.h>
#include <network/rivers.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/vec.hpp>

namespace import_divergences_test {

using namespace thalweg;
using network::import_lines;
using network::ImportedNetwork;
using network::Orientation;

namespace {

using test::flats;

std::set<std::int64_t> in_network(ImportedNetwork const& imported) {
    std::set<std::int64_t> features;
    for (auto const& stretches : imported.stretches) {
        for (Stretch const& s : stretches) {
            features.insert(s.feature);
        }
    }
    return features;
}

std::set<std::int64_t> beside(ImportedNetwork const& imported) {
    std::set<std::int64_t> features;
    for (SecondaryLine const& s : imported.secondary) {
        features.insert(s.feature);
    }
    return features;
}

using Features = std::set<std::int64_t>;

double total_m(ImportedNetwork const& imported) {
    double sum = 0.0;
    for (double const m : imported.network.length_m()) {
        sum += m;
    }
    for (SecondaryLine const& s : imported.secondary) {
        sum += length_in_plan(s.vertices);
    }
    return sum;
}

// Law: trees, and every secondary piece has a repair.
void expect_forest(ImportedNetwork const& imported) {
    EXPECT_EQ(imported.network.node_count(), imported.network.arc_count() + imported.network.outlets().size());
    for (NodeId n = 0; n < imported.network.node_count(); ++n) {
        EXPECT_LE(imported.network.out_arcs(n).size(), 1U);
        EXPECT_GT(imported.network.basin(n), 0);
    }
    EXPECT_EQ(std::ranges::count(imported.repairs, std::string_view("secondary"), &Finding::kind),
              static_cast<std::ptrdiff_t>(imported.secondary.size()));
    ASSERT_EQ(imported.stretches.size(), imported.network.arc_count());
    for (std::size_t a = 0; a < imported.network.arc_count(); ++a) {
        EXPECT_EQ(imported.stretches[a].front().from_m, 0.0);
        EXPECT_NEAR(imported.stretches[a].back().to_m, imported.network.length_m(a),
                    1e-9 * imported.network.length_m(a));
    }
}

// A river from north to south with a channel beside it from (0, 60) to (0, 20), in two lines.
std::vector<std::vector<Vec2>> braid() {
    return {{{0, 90}, {0, 60}}, {{0, 60}, {0, 20}}, {{0, 20}, {0, 0}}, {{0, 60}, {15, 40}}, {{15, 40}, {0, 20}}};
}

/// What stays when these features are beside the main path.
ImportedNetwork expect_beside(RiverLines const& lines, Features const& features,
                              network::ImportParams const& params = {}) {
    ImportedNetwork imported = import_lines(lines, params);
    EXPECT_EQ(beside(imported), features);
    expect_forest(imported);
    return imported;
}

} // namespace

TEST(AdoptDivides, TheStraightChannelOfABraidStays) {
    auto const imported = expect_beside(flats(braid()), {4, 5});
    EXPECT_EQ(imported.network.arc_count(), 1U);
    EXPECT_EQ(in_network(imported), (Features{1, 2, 3}));
}

TEST(AdoptDivides, AMinorChannelIsAStreamFromWhereOneWithASourceJoins) {
    auto plans = braid();
    plans.push_back({{60, 60}, {15, 40}});
    auto const imported = import_lines(flats(plans));
    EXPECT_EQ(in_network(imported), (Features{1, 2, 3, 5, 6}));
    EXPECT_EQ(beside(imported), (Features{4}));
    expect_forest(imported);
}

TEST(AdoptDivides, ByWhatTheFileSays) {
    auto marked = flats(braid());
    marked.lines[1].channel = Channel::minor;
    marked.lines[3].channel = Channel::main;
    auto linked = flats(braid());
    linked.lines[0].down = 4;
    linked.lines[3].down = 5;
    linked.lines[4].down = linked.lines[1].down = 3;
    auto sized = flats(braid());
    sized.lines[3].size = {2.0};
    sized.lines[1].size = {1.0};
    auto named = flats(braid());
    named.lines[0].name = named.lines[3].name = "Po";
    for (RiverLines const& lines : {marked, linked, sized, named}) {
        expect_beside(lines, {2});
    }
}

// Sizes are compared one after another: the next decides where one is the same, or known of neither.
TEST(AdoptDivides, ByTheNextSizeWhereOneTies) {
    auto lines = flats(braid());
    for (auto& line : lines.lines) {
        line.size = {7.0, 0.0, 1.0};
    }
    expect_beside(lines, {4, 5}); // by the angle
    lines.lines[3].size = {7.0, 0.0, 2.0};
    expect_beside(lines, {2});
    lines.lines[1].size = {7.0, 0.5, 1.0};
    expect_beside(lines, {4, 5});
    lines.lines[3].size = {8.0, 0.0, 0.0};
    expect_beside(lines, {2});
}

TEST(AdoptDivides, ByRankWhereNothingFinerTells) {
    auto lines = flats(braid());
    std::int64_t const rank[] = {50, 40, 10, 30, 20}; // numbered upstream, first along the channel beside
    for (std::size_t i = 0; i < lines.lines.size(); ++i) {
        lines.lines[i].rank = rank[i];
    }
    for (auto const orientation : {Orientation::automatic, Orientation::rank, Orientation::as_drawn}) {
        expect_beside(lines, {2}, {.orientation = orientation});
    }
    lines.lines[1].rank = 25;
    expect_beside(lines, {4, 5});
    lines.lines[3].size = {2.0};
    for (std::size_t const other : {0U, 1U, 2U, 4U}) {
        lines.lines[other].size = {1.0};
    }
    expect_beside(lines, {2}); // size is finer
    lines.lines[3].rank = 0;
    lines.lines[3].size = {1.0};
    expect_beside(lines, {4, 5}); // a branch without a rank is the last
}

TEST(AdoptDivides, LinksTellTheDirectionWhateverWasDrawn) {
    auto plans = braid();
    for (auto& plan : plans) {
        std::ranges::reverse(plan);
    }
    auto lines = flats(plans);
    lines.lines[0].down = 2;
    lines.lines[1].down = 3;
    lines.lines[3].down = 5;
    lines.lines[4].down = 3;
    auto const imported = import_lines(lines);
    ASSERT_EQ(imported.network.outlets().size(), 1U);
    EXPECT_EQ(imported.network.node(imported.network.outlets()[0]).at, (Vec2{0, 0}));
    EXPECT_EQ(beside(imported), (Features{4, 5}));
    expect_forest(imported);
}

TEST(AdoptDivides, ADistributaryIsSecondaryWhereTheFileIsCertain) {
    auto lines = flats({{{0, 90}, {0, 50}}, {{0, 50}, {0, 0}}, {{0, 50}, {40, 0}}});
    expect_beside(lines, {3}, {.orientation = Orientation::as_drawn});
    lines.lines[0].down = 2;
    EXPECT_EQ(expect_beside(lines, {3}).network.arc_count(), 1U);
}

TEST(AdoptDivides, ACircleIsOpenedWhereWaterCanLeaveIt) {
    // Round (0, 0), (10, 0), (5, 10); fed at (0, 0), left at (10, 0).
    auto const imported = import_lines(
        flats({{{0, 0}, {10, 0}}, {{10, 0}, {5, 10}}, {{5, 10}, {0, 0}}, {{-30, 0}, {0, 0}}, {{10, 0}, {40, -20}}}));
    EXPECT_EQ(in_network(imported), (Features{1, 4, 5}));
    EXPECT_EQ(beside(imported), (Features{2, 3}));
    expect_forest(imported);
}

TEST(AdoptDivides, RingsAreSecondaryAndNotAllThereMayBe) {
    std::vector<Vec2> const pond{{50, 50}, {60, 50}, {60, 60}, {50, 50}};
    auto const imported = import_lines(flats({{{0, 0}, {10, 0}}, pond}));
    EXPECT_EQ(beside(imported), (Features{2}));
    expect_forest(imported);
    EXPECT_TRUE(test::refused(
        "network.import_lines", [&] { import_lines(flats({pond})); }, "closed rings"));
}

TEST(AdoptDivides, ARiverThroughAPondKeepsOneShore) {
    auto const imported = import_lines(flats({{{0, 100}, {0, 60}},
                                              {{0, 60}, {10, 50}, {0, 40}, {-20, 50}, {0, 60}}, // round the pond
                                              {{0, 40}, {0, 0}}}));
    ASSERT_EQ(imported.network.outlets().size(), 1U);
    EXPECT_EQ(imported.network.node(imported.network.outlets()[0]).at, (Vec2{0, 0}));
    EXPECT_EQ(in_network(imported), (Features{1, 2, 3}));
    EXPECT_EQ(beside(imported), (Features{2}));
    expect_forest(imported);
}

TEST(AdoptDivides, WithoutDirectionsTheShortestWaysStay) {
    auto const imported = expect_beside(flats(braid()), {4, 5}, {.orientation = Orientation::topology});
    EXPECT_EQ(in_network(imported), (Features{1, 2, 3}));
}

TEST(AdoptDivides, HeightsThatLeadIntoADeepPitAreRefused) {
    RiverLines lines = flats({{{0, 90}, {0, 60}}, {{0, 60}, {0, 30}}, {{0, 30}, {0, 20}}, {{50, 60}, {0, 60}}});
    lines.has_z = true;
    auto const raise = [&](double factor) {
        double const z[4][2] = {{9, 2}, {2, 5}, {5, 1}, {8, 2}};
        for (std::size_t i = 0; i < 4; ++i) {
            lines.lines[i].vertices[0].z = factor * z[i][0];
            lines.lines[i].vertices[1].z = factor * z[i][1];
        }
    };
    raise(1.0); // 3 m are noise: water runs where it climbs least, though most of the length says otherwise
    ImportedNetwork const noisy = import_lines(lines);
    ASSERT_EQ(noisy.network.outlets().size(), 1U);
    EXPECT_EQ(noisy.network.node(noisy.network.outlets()[0]).at, (Vec2{0, 20}));
    EXPECT_EQ(in_network(noisy), (Features{1, 2, 3, 4}));
    raise(10.0);
    EXPECT_TRUE(test::refused(
        "network.import_lines", [&] { import_lines(lines); }, "which no river leaves"));
}

// Law: of any lattice of channels a forest stays, and nothing of what was drawn is lost, whatever the directions.
TEST(AdoptDivides, LatticesBecomeForests) {
    ASSERT_TRUE(rc::check([] {
        test::Lattice const lattice = test::random_lattice(*rc::gen::inRange(2, 40), *rc::gen::inRange(0, 20));
        std::vector<std::vector<Vec2>> plans;
        double drawn_m = 0.0;
        for (auto const& [a, b] : lattice.edges) {
            bool const turned = *rc::gen::arbitrary<bool>();
            plans.push_back({lattice.at[turned ? b : a], lattice.at[turned ? a : b]});
            drawn_m += distance(lattice.at[a], lattice.at[b]);
        }
        auto lines = flats(plans);
        for (auto& line : lines.lines) {
            line.down = *rc::gen::inRange<std::int64_t>(0, static_cast<std::int64_t>(plans.size()) + 1);
        }
        Orientation const orientation = *rc::gen::element(Orientation::automatic, Orientation::least_turned,
                                                          Orientation::as_drawn, Orientation::topology);
        ImportedNetwork imported;
        try {
            imported = import_lines(lines, {.orientation = orientation});
        } catch (BadInput const&) {
            RC_DISCARD("nothing is left");
        }
        RC_ASSERT(imported.network.node_count() == imported.network.arc_count() + imported.network.outlets().size());
        RC_ASSERT(imported.network.upstream_order().size() == imported.network.node_count());
        double const kept_m = total_m(imported);
        RC_ASSERT(kept_m > drawn_m * (1.0 - 1e-9));
        RC_ASSERT(kept_m < drawn_m * (1.0 + 1e-9));
        auto all = in_network(imported);
        all.merge(beside(imported));
        RC_ASSERT(all.size() == plans.size());
    }));
}

} // namespace import_divergences_test
