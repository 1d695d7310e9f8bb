// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/slopes.hpp>

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/error.hpp>

#include "dems.hpp"

namespace level_patch_test {

using namespace thalweg;
using measure::level_patch;
using measure::LevelPatch;

namespace {

enum class Ground { none, steep, gentle };

Ground ground_at(Raster<float> const& dem, Cell at, double below_deg) {
    auto const z = [&](std::int64_t col, std::int64_t row) {
        return static_cast<double>(dem[Cell{at.col + col, at.row + row}]);
    };
    if (at.col == 0 || at.row == 0 || at.col + 1 == dem.width() || at.row + 1 == dem.height()) {
        return Ground::none;
    }
    bool lake = true;
    for (Cell const step : d8_steps) {
        lake = lake && z(step.col, step.row) == z(0, 0);
    }
    double const x = (z(1, -1) + 2 * z(1, 0) + z(1, 1) - z(-1, -1) - 2 * z(-1, 0) - z(-1, 1)) / 8;
    double const y = (z(-1, 1) + 2 * z(0, 1) + z(1, 1) - z(-1, -1) - 2 * z(0, -1) - z(1, -1)) / 8;
    double const degrees = std::atan(std::sqrt(x * x + y * y)) * 180.0 / 3.14159265358979323846;
    if (lake || std::isnan(degrees) || std::isnan(z(0, 0))) {
        return Ground::none;
    }
    return degrees < below_deg ? Ground::gentle : Ground::steep;
}

/// Every cell takes its neighbours' lowest number until none changes.
std::int64_t largest_by_numbers(Raster<float> const& dem, double below_deg) {
    std::vector<std::int64_t> number(static_cast<std::size_t>(dem.cells()), -1);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (ground_at(dem, dem.grid().at(i), below_deg) == Ground::gentle) {
            number[static_cast<std::size_t>(i)] = i;
        }
    }
    bool changes = true;
    while (changes) {
        changes = false;
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            for (Cell const step : d8_steps) {
                Cell const there{dem.grid().at(i).col + step.col, dem.grid().at(i).row + step.row};
                auto& mine = number[static_cast<std::size_t>(i)];
                if (mine >= 0 && dem.grid().contains(there)) {
                    auto const other = number[static_cast<std::size_t>(dem.grid().index(there))];
                    if (other >= 0 && other < mine) {
                        mine = other;
                        changes = true;
                    }
                }
            }
        }
    }
    std::int64_t largest = 0;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        largest = std::max<std::int64_t>(largest, std::count(number.begin(), number.end(), i));
    }
    return largest;
}

} // namespace

TEST(LevelPatch, RefusesNonsense) {
    Raster<float> const dem = rough_dem(frame(9, 9), 1);
    EXPECT_THROW(level_patch(dem, {.below_deg = 0.0}), BadParameter);
    EXPECT_THROW(level_patch(dem, {.below_deg = 90.0}), BadParameter);
    Grid grid = frame(9, 9);
    grid.cell_m = 0.0;
    EXPECT_THROW(level_patch(rough_dem(grid, 1)), BadInput);
}

TEST(LevelPatch, LakesAreNoLand) {
    LevelPatch const lake = level_patch(Raster<float>(frame(9, 9), 4.0F));
    EXPECT_EQ(lake.cells, 0);
    EXPECT_EQ(lake.land, 0);
    EXPECT_EQ(level_patch(Raster<float>{}).land, 0);
}

TEST(LevelPatch, AsFoundByNumbers) {
    ASSERT_TRUE(rc::check("the largest 8-connected patch", [] {
        Raster<float> const dem = *gen_dem(14, 10);
        double const below_deg = *rc::gen::element(3.0, 20.0, 45.0, 60.0);
        LevelPatch const found = level_patch(dem, {.below_deg = below_deg});
        std::int64_t land = 0;
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            land += ground_at(dem, dem.grid().at(i), below_deg) == Ground::none ? 0 : 1;
        }
        RC_ASSERT(found.land == land);
        RC_ASSERT(found.cells == largest_by_numbers(dem, below_deg));
    }));
}

} // namespace level_patch_test
