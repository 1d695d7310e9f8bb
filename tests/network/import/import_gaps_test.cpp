// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Gaps between lines that belong together, and between those that do not.
#include <thalweg/network/import/import_lines.hpp>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <network/rivers.hpp>
#include <rapidcheck.h>
#include <support.hpp>

namespace import_gaps_test {

using namespace thalweg;
using network::import_lines;
using network::ImportedNetwork;
using network::ImportParams;

namespace {

constexpr ImportParams on_cells{.cell_m = 10.0};

/// Lines with a direction column: they run as drawn.
RiverLines drawn(std::vector<std::vector<Vec2>> const& all) {
    RiverLines rivers = test::flats(all);
    for (RiverLine& line : rivers.lines) {
        line.runs = 1;
    }
    return rivers;
}

std::vector<double> joined_m(ImportedNetwork const& imported) {
    std::vector<double> gaps;
    for (Finding const& repair : imported.repairs) {
        if (repair.kind == FindingKind("snapped")) {
            gaps.push_back(repair.amount);
        }
    }
    return gaps;
}

std::size_t outlets(RiverLines const& lines, ImportParams const& params = on_cells) {
    return import_lines(lines, params).network.outlets().size();
}

} // namespace

TEST(ImportGaps, AnEndJoinsWhatLiesWithinHalfACell) {
    RiverLines const lines = drawn({{{0, 0}, {400, 0}}, {{404, 2}, {900, 0}}, {{300, 300}, {600, 6}}});
    EXPECT_EQ(outlets(lines, {}), 3U);
    ImportedNetwork const imported = import_lines(lines, on_cells);
    EXPECT_EQ(imported.network.outlets().size(), 1U);
    std::vector<double> const gaps = joined_m(imported);
    ASSERT_EQ(gaps.size(), 2U);
    EXPECT_NEAR(gaps[0], std::hypot(4, 2), 1e-9);
    EXPECT_NEAR(gaps[1], 4.8, 0.1) << "to the line, not to its nearest vertex";
}

TEST(ImportGaps, FartherOnlyWhereTheNextCandidateIsFiveTimesAsFar) {
    std::vector<std::vector<Vec2>> stem{{{0, 0}, {400, 0}}, {{415, 0}, {900, 0}}};
    EXPECT_EQ(outlets(drawn(stem)), 1U);
    stem.push_back({{400, -60}, {380, -400}}); // four times as far
    EXPECT_EQ(outlets(drawn(stem)), 3U);
    stem.back().front().y = -80;
    EXPECT_EQ(outlets(drawn(stem)), 2U);
    EXPECT_EQ(outlets(drawn({{{0, 0}, {400, 0}}, {{421, 0}, {900, 0}}})), 2U) << "beyond two cells";
}

TEST(ImportGaps, SpringsJoinNothingButWhatGivesWater) {
    EXPECT_EQ(outlets(drawn({{{0, 0}, {-400, 0}}, {{3, 0}, {400, 0}}})), 2U) << "two springs on a divide";
    EXPECT_EQ(outlets(drawn({{{0, -400}, {0, 400}}, {{3, 0}, {400, 0}}})), 2U) << "a spring beside a river";
    EXPECT_EQ(outlets(drawn({{{0, -400}, {0, 400}}, {{400, 0}, {3, 0}}})), 1U) << "a mouth beside it";
}

TEST(ImportGaps, NothingCollapsesAndNoLoopIsClosed) {
    // A meander that comes back to 3 m from itself; its ends stay.
    RiverLines const bend = drawn({{{0, 0}, {200, 0}, {200, 100}, {100, 100}}, {{100, 100}, {100, 3}}});
    ImportedNetwork const imported = import_lines(bend, on_cells);
    EXPECT_TRUE(joined_m(imported).empty());
    EXPECT_EQ(imported.network.arc_count(), 1U);
}

TEST(ImportGaps, LinksJoinOverATenthOfTheShorterLine) {
    RiverLines lines = drawn({{{0, 0}, {400, 0}}, {{435, 0}, {900, 0}}, {{435, 50}, {900, 50}}});
    lines.lines[0].down = lines.lines[1].feature;
    EXPECT_EQ(outlets(lines), 2U);
    lines.lines[0].vertices[1].x = 390.0; // a gap of 45 m
    EXPECT_EQ(outlets(lines), 3U);
}

TEST(ImportGaps, EndsAtTheEdgeOfAGridJoinNothing) {
    RiverLines lines = drawn({{{0, 0}, {400, 0}}, {{415, 0}, {900, 0}}});
    lines.lines[0].down = lines.lines[1].feature; // named, and near
    EXPECT_EQ(outlets(lines), 1U);
    lines.lines[0].ends_at_edge = lines.lines[1].begins_at_edge = true;
    EXPECT_EQ(outlets(lines), 2U);
}

TEST(ImportGaps, AStepBackWithinACellIsStraightened) {
    RiverLines const lines = drawn({{{0, 0}, {400, 0}, {399.3, 0.0005}, {900, 0}}});
    for (double const cell_m : {0.0, 10.0}) {
        ImportedNetwork const imported = import_lines(lines, {.cell_m = cell_m});
        EXPECT_EQ(imported.network.arc(0).line.size(), cell_m > 0.0 ? 3U : 4U);
        EXPECT_NEAR(imported.network.length_m(0), cell_m > 0.0 ? 900.0 : 901.4, 1e-3);
    }
}

TEST(ImportGaps, ARiverDrawnTwiceIsOneRiver) {
    std::vector<std::vector<Vec2>> all{{{0, 0}, {400, 0}, {900, 50}}, {{300, 300}, {400, 0}}};
    double const once_m = 400.0 + std::hypot(500, 50) + std::hypot(100, 300);
    all.push_back({{1, 1.5}, {200, 1.5}, {400, 1.5}, {650, 26}, {899, 51}}); // of another source, other vertices
    all.push_back({{600, 300}, {650, 26}});                                  // which has one more tributary
    ImportedNetwork const imported = import_lines(drawn(all), on_cells);
    EXPECT_EQ(imported.network.outlets().size(), 1U);
    EXPECT_EQ(imported.secondary.size(), 1U);
    double length_m = 0.0;
    for (ArcId a = 0; a < imported.network.arc_count(); ++a) {
        length_m += imported.network.length_m(a);
    }
    EXPECT_NEAR(length_m, once_m + std::hypot(50, 274), 5.0);
    EXPECT_EQ(import_lines(drawn({all[0], all[1], {{0, 40}, {900, 90}}}), on_cells).secondary.size(), 0U);
}

TEST(ImportGaps, ATreeWithGapsIsTheTree) {
    ASSERT_TRUE(rc::check([] {
        auto const pieces = *rc::gen::inRange(2, 12);
        std::vector<std::vector<Vec2>> all;
        for (int i = 0; i < pieces; ++i) { // a stem of pieces 300 m long, a tributary to each joint
            double const x = 300.0 * i;
            double const gap = 0.01 * *rc::gen::inRange(1, 490);
            all.push_back({{x + gap, 0}, {x + 150, 20}, {x + 300, 0}});
            double const short_m = 0.01 * *rc::gen::inRange(1, 350);
            all.push_back({{x + 200, 250}, {x + 300 - short_m, short_m}});
        }
        all.push_back({{300.0 * pieces, 0}, {300.0 * pieces + 500, 0}});
        ImportedNetwork const imported = import_lines(drawn(all), on_cells);
        RC_ASSERT(imported.network.outlets().size() == 1U);
        RC_ASSERT(imported.secondary.empty());
        for (double const gap : joined_m(imported)) {
            RC_ASSERT(gap <= 5.0);
        }
    }));
}

} // namespace import_gaps_test
