// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/slopes.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/error.hpp>

#include "dems.hpp"

namespace slopes_test {

using namespace thalweg;
using measure::level_patch;
using measure::LevelPatch;
using measure::Slopes;
using measure::slopes;

namespace {

using test::on_threads;

/// Horn's gradient of every cell that has one, written out.
std::vector<std::pair<double, double>> gradients(Raster<float> const& dem) {
    std::vector<std::pair<double, double>> all;
    for (std::int64_t r = 1; r + 1 < dem.height(); ++r) {
        for (std::int64_t c = 1; c + 1 < dem.width(); ++c) {
            auto const z = [&](std::int64_t dc, std::int64_t dr) {
                return static_cast<double>(dem[Cell{c + dc, r + dr}]);
            };
            double const dx = (z(1, -1) + 2 * z(1, 0) + z(1, 1) - z(-1, -1) - 2 * z(-1, 0) - z(-1, 1)) / 8.0;
            double const dy = (z(-1, 1) + 2 * z(0, 1) + z(1, 1) - z(-1, -1) - 2 * z(0, -1) - z(1, -1)) / 8.0;
            if (!std::isnan(dx + dy + z(0, 0))) {
                all.emplace_back(dx / dem.grid().cell_m, dy / dem.grid().cell_m);
            }
        }
    }
    return all;
}

double degrees(double angle) {
    return angle * 180.0 / std::numbers::pi;
}

Raster<float> plane(double towards_deg, double tangent, double cell_m) {
    Grid grid = frame(9, 7);
    grid.cell_m = cell_m;
    double const angle = towards_deg * std::numbers::pi / 180.0;
    return test::raster_of(grid, [&](Cell c) {
        return tangent * cell_m *
               (std::cos(angle) * static_cast<double>(c.col) + std::sin(angle) * static_cast<double>(c.row));
    });
}

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

TEST(Slopes, NoneOfTooLittleLand) {
    for (Raster<float> const& dem : {Raster<float>{}, dem_of(1, {1.0F}), Raster<float>(frame(2, 9), 1.0F),
                                     Raster<float>(frame(9, 2), 1.0F), Raster<float>(frame(5, 5), hole)}) {
        Slopes const found = slopes(dem);
        EXPECT_EQ(found.cells, 0);
        EXPECT_TRUE(std::isnan(found.mean_deg));
        EXPECT_TRUE(std::isnan(found.percentile_deg[3]));
        EXPECT_TRUE(found.shares.empty());
    }
    Grid none = frame(5, 5);
    none.cell_m = -1.0;
    EXPECT_THROW(slopes(Raster<float>(none, 1.0F)), BadInput);
}

TEST(Slopes, LevelLandFacesNowhere) {
    Slopes const found = slopes(Raster<float>(frame(6, 5), 3.0F));
    EXPECT_EQ(found.cells, 12);
    EXPECT_EQ(found.mean_deg, 0.0);
    EXPECT_EQ(found.shares.front(), 1.0);
    EXPECT_TRUE(std::isnan(found.aspects_along_grid));
}

TEST(Slopes, PlanesFaceWhereTheyAreTurned) {
    for (double const tangent : {0.1, 1.0, 20.0}) {
        for (int deg = 1; deg < 360; deg += 4) {
            Slopes const found = slopes(plane(deg, tangent, 30.0));
            EXPECT_EQ(found.cells, 35);
            EXPECT_NEAR(found.mean_deg, degrees(std::atan(tangent)), 1e-4);
            EXPECT_NEAR(found.percentile_deg[3], found.mean_deg, 0.0101);
            EXPECT_NEAR(found.tangent_cv, 0.0, 1e-3);
            double const off = std::fabs(std::remainder(deg, 45.0));
            EXPECT_EQ(found.aspects_along_grid, off < 11.25 ? 2.0 : 0.0) << deg;
            EXPECT_NEAR(found.aspects_on_grid, off < 2.5 ? 9.0 : 0.0, 1e-12) << deg;
        }
    }
}

TEST(Slopes, AsDefined) {
    ASSERT_TRUE(rc::check("mean, deviation, percentiles and aspects of Horn's gradients", [] {
        Raster<float> const dem = *gen_dem(20, 20);
        auto const all = gradients(dem);
        Slopes const found = slopes(dem);
        RC_ASSERT(found.cells == static_cast<std::int64_t>(all.size()));
        if (all.empty()) {
            return;
        }
        std::vector<double> deg;
        double along = 0.0;
        double facing = 0.0;
        for (auto const& [dx, dy] : all) {
            deg.push_back(degrees(std::atan(std::hypot(dx, dy))));
            if (dx != 0.0 || dy != 0.0) {
                facing += 1.0;
                along += std::fabs(std::remainder(degrees(std::atan2(dy, dx)), 45.0)) <= 11.25 + 1e-9 ? 1.0 : 0.0;
            }
        }
        double const mean = std::accumulate(deg.begin(), deg.end(), 0.0) / static_cast<double>(deg.size());
        RC_ASSERT(std::fabs(found.mean_deg - mean) < 1e-9);
        double squares = 0.0;
        for (double const d : deg) {
            squares += (d - mean) * (d - mean);
        }
        RC_ASSERT(std::fabs(found.std_deg - std::sqrt(squares / static_cast<double>(deg.size()))) < 1e-5);
        std::sort(deg.begin(), deg.end());
        for (std::size_t p = 0; p < measure::slope_percents.size(); ++p) {
            double const place = measure::slope_percents[p] / 100.0 * static_cast<double>(deg.size());
            double const at = deg[static_cast<std::size_t>(std::max(std::ceil(place - 1e-9) - 1.0, 0.0))];
            RC_ASSERT(std::fabs(found.percentile_deg[p] - at) < 0.0101);
        }
        RC_ASSERT(std::fabs(std::accumulate(found.shares.begin(), found.shares.end(), 0.0) - 1.0) < 1e-12);
        if (facing > 0.0) {
            RC_ASSERT(std::fabs(found.aspects_along_grid - 2.0 * along / facing) < 1e-9);
        }
    }));
}

// A cone faces every way alike, and a smooth random land nearly so.
TEST(Slopes, AConeFacesEveryWay) {
    Raster<float> dem(frame(401, 401));
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Cell const c = dem.grid().at(i);
        dem[i] = static_cast<float>(std::hypot(static_cast<double>(c.col) - 200.3, static_cast<double>(c.row) - 199.8));
        if (std::hypot(static_cast<double>(c.col) - 200.3, static_cast<double>(c.row) - 199.8) > 190.0) {
            dem[i] = hole;
        }
    }
    Slopes const found = slopes(dem);
    EXPECT_NEAR(found.aspects_along_grid, 1.0, 0.005);
    EXPECT_NEAR(found.aspects_on_grid, 1.0, 0.01);
    EXPECT_NEAR(found.mean_deg, 45.0, 0.1);
}

TEST(Slopes, SameBitsForAnyThreads) {
    Raster<float> const dem = rough_dem(frame(300, 500), 11);
    thalweg::Run const one = on_threads(1);
    thalweg::Run const five = on_threads(5);
    Slopes const a = slopes(dem, one);
    Slopes const b = slopes(dem, five);
    EXPECT_EQ(a.mean_deg, b.mean_deg);
    EXPECT_EQ(a.std_deg, b.std_deg);
    EXPECT_EQ(a.tangent_cv, b.tangent_cv);
    EXPECT_EQ(a.shares, b.shares);
    EXPECT_EQ(a.percentile_deg, b.percentile_deg);
    EXPECT_EQ(a.aspects_on_grid, b.aspects_on_grid);
}

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

} // namespace slopes_test
