// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/skeleton/ridges.hpp>

namespace given_ridges_test {

using namespace thalweg;

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

RiverLines lines_of(std::vector<Vec3> vertices) {
    RiverLines lines;
    lines.lines.emplace_back().vertices = std::move(vertices);
    return lines;
}

/// A river at 100 m down the first column.
Valley valley_on(Grid const& grid) {
    Valley valley{Raster<float>(grid, std::numeric_limits<float>::quiet_NaN())};
    for (std::int64_t row = 0; row < grid.height; ++row) {
        valley.z[Cell{0, row}] = 100.0F;
    }
    return valley;
}

} // namespace

TEST(GivenRidges, CellsOfALineHaveSidesInCommon) {
    ASSERT_TRUE(rc::check("a line steps by one side, with heights between those of its vertices", [] {
        Grid const grid = test::frame(30, 20, 5.0);
        std::vector<Vec3> line;
        for (int i = 0; i < 4; ++i) {
            line.push_back({*rc::gen::inRange(1, 149) * 1.0, *rc::gen::inRange(1, 99) * 1.0, i * 1.0});
        }
        auto const cells = skeleton::cells_of_line(line, grid);
        RC_ASSERT(cells.front().cell == grid.index(grid.cell_of(in_plan(line.front()))));
        RC_ASSERT(cells.back().cell == grid.index(grid.cell_of(in_plan(line.back()))));
        for (std::size_t i = 0; i < cells.size(); ++i) {
            RC_ASSERT((cells[i].z_m >= 0.0 && cells[i].z_m <= 3.0));
            Cell const here = grid.at(cells[i].cell);
            Cell const last = grid.at(cells[i == 0 ? 0 : i - 1].cell);
            std::int64_t const steps = std::abs(here.col - last.col) + std::abs(here.row - last.row);
            RC_ASSERT(steps == (i == 0 ? 0 : 1));
        }
    }));
}

TEST(GivenRidges, RiseFromTheNearestRiverUnlessTheyHaveHeights) {
    Grid const grid = test::frame(30, 20, 10.0);
    Valley const valley = valley_on(grid);
    RidgeLines const made = skeleton::ridges_with_heights(lines_of({{5.0, 5.0, none}, {295.0, 195.0, none}}), valley,
                                                          {.gain = 0.5, .farthest_m = 120.0});
    ASSERT_EQ(made.lines.size(), 1U);
    for (Vec3 const& v : made.lines[0].line) {
        EXPECT_DOUBLE_EQ(v.z, 100.0 + 0.5 * std::min(v.x - 5.0, 120.0));
    }
    FeaturePoints const points = skeleton::as_points(made, grid);
    EXPECT_EQ(points.points.size(), made.lines[0].line.size());
    std::vector<Vec3> const with_heights{{5.0, 5.0, 7.0}, {295.0, 195.0, 9.0}};
    EXPECT_EQ(skeleton::ridges_with_heights(lines_of(with_heights), valley, {}).lines[0].line, with_heights);
    RidgeLines const on = skeleton::ridges_on(lines_of({{5.0, 5.0, none}, {8.0, 95.0, none}}), valley.z);
    for (Vec3 const& v : on.lines[0].line) {
        EXPECT_EQ(v.z, 100.0);
    }
}

} // namespace given_ridges_test
