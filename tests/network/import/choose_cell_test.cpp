// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/choose_cell.hpp>

#include <cmath>

#include <gtest/gtest.h>
#include <network/rivers.hpp>
#include <rapidcheck/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

namespace choose_cell_test {

namespace {

using namespace thalweg;
using network::choose_cell;
using test::lines_of;

/// A straight line with a vertex every step.
std::vector<Vec3> straight(Vec2 from, Vec2 to, double step) {
    std::vector<Vec3> line;
    auto const n = static_cast<int>(std::ceil(distance(from, to) / step));
    for (int i = 0; i <= n; ++i) {
        double const t = static_cast<double>(i) / n;
        line.push_back({from.x + t * (to.x - from.x), from.y + t * (to.y - from.y), 0.0});
    }
    return line;
}

double cells_with(double wide, double tall, double cell) {
    double const margin = 0.1 * std::max(wide, tall);
    return std::ceil((wide + margin) / cell) * std::ceil((tall + margin) / cell);
}

bool is_round(double cell) {
    for (double unit = 1e-3; unit < 1e5; unit *= 10.0) {
        for (double const step : {1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 7.5, 9.0}) {
            if (std::fabs(cell - step * unit) < 1e-9 * cell) {
                return true;
            }
        }
    }
    return false;
}

} // namespace

TEST(ChooseCell, NoLinesOrNoExtentAreRefused) {
    for (RiverLines const& wrong : {RiverLines(), lines_of({{{5, 5, 0}, {5, 5, 0}}})}) {
        EXPECT_TRUE(test::refused("network.choose_cell", [&] { choose_cell(wrong); }));
    }
}

TEST(ChooseCell, OneShortLine) {
    network::ChosenCell const chosen = choose_cell(lines_of({{{0, 0, 0}, {1000, 0, 0}}}));
    EXPECT_EQ(chosen.cell_m, 1.25); // 1000 cells, although it is drawn with two vertices
    EXPECT_EQ(chosen.lines, 1);
    EXPECT_EQ(chosen.length_m, 1000.0);
    EXPECT_EQ(chosen.crowded_share, 0.0);
}

TEST(ChooseCell, SixtyMetresForABasinOfFiftyKilometres) {
    network::ChosenCell const chosen =
        choose_cell(lines_of({straight({0, 0}, {50000, 0}, 50), straight({20000, 100}, {20000, 73000}, 50)}));
    EXPECT_EQ(chosen.cell_m, 60.0);
    EXPECT_NEAR(chosen.spacing_m, 57300.0 * 80200.0 / 122900.0, 500.0);
}

TEST(ChooseCell, RiversSideBySideAskForSmallerCells) {
    // Twenty pairs 115 m apart that never meet: in cells of 60 m many would lie side by side.
    std::vector<std::vector<Vec3>> pairs;
    for (int i = 0; i < 20; ++i) {
        double const y = 3500.0 * i + i;
        pairs.push_back(straight({0, y}, {50000, y}, 50));
        pairs.push_back(straight({0, y + 115}, {50000, y + 115}, 50));
    }
    network::ChosenCell const chosen = choose_cell(lines_of(pairs));
    EXPECT_EQ(chosen.cell_m, 50.0);
    EXPECT_LE(chosen.crowded_share, 0.002);
    network::ChosenCell const usual = choose_cell(lines_of(pairs), {.most_cells = 1500000});
    EXPECT_EQ(usual.cell_m, 60.0);
    EXPECT_GT(usual.crowded_share, 0.01);
    EXPECT_EQ(usual.enough_m, 50.0);
}

TEST(ChooseCell, RiversThatMeetAreNotCrowded) {
    std::vector<std::vector<Vec3>> comb{straight({0, 0}, {20000, 0}, 50)};
    for (int i = 1; i < 20; ++i) {
        comb.push_back(straight({1000.0 * i, 15000}, {1000.0 * i, 0}, 30));
    }
    EXPECT_EQ(choose_cell(lines_of(comb)).crowded_share, 0.0);
    // A head close to another river does not meet it.
    for (auto& line : comb) {
        line.back().y += line.back().y == 0.0 && line.front().y > 0.0 ? 15.0 : 0.0;
    }
    EXPECT_GT(choose_cell(lines_of(comb), {.most_cells = 1500000}).crowded_share, 0.0);
}

TEST(ChooseCell, OfAGivenGridItFits) {
    RiverLines const rivers = lines_of({straight({0, 0}, {10000, 4000}, 30)});
    double const cell = choose_cell(rivers, {.width = 1024, .height = 1024}).cell_m;
    EXPECT_EQ(cell, 12.5); // 11000 m on 1024 cells
    EXPECT_EQ(choose_cell(rivers, {.width = 2048, .height = 100}).cell_m, 50.0);
}

RC_GTEST_PROP(ChooseCell, ARoundNumberAndFewEnoughCells, ()) {
    double const wide = *rc::gen::inRange(1, 2000000);
    double const tall = *rc::gen::inRange(0, 2000000);
    double const step = *rc::gen::inRange(1, 5000);
    RiverLines const rivers = lines_of({straight({0, 0}, {wide, tall}, std::max(step, wide / 1000.0))});
    double const cell = choose_cell(rivers).cell_m;
    RC_ASSERT(is_round(cell));
    RC_ASSERT(cells_with(wide, tall, cell) <= 2000000.0);
}

} // namespace choose_cell_test
