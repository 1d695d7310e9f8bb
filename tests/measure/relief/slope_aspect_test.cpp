// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/slope_aspect.hpp>

#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>
#include <measure/dems.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/measure/relief/slopes.hpp>
#include <thalweg/measure/relief/swath.hpp>

namespace slope_aspect_test {

using namespace thalweg;

namespace {

/// A plane that falls by a slope towards an azimuth.
Raster<float> plane(double slope_deg, double azimuth_deg) {
    double const fall = std::tan(slope_deg * std::numbers::pi / 180.0);
    double const azimuth = azimuth_deg * std::numbers::pi / 180.0;
    return test::raster_of(frame(7, 6), [&](Cell c) {
        double const cell_m = frame(7, 6).cell_m;
        double const east = static_cast<double>(c.col) * cell_m;
        double const north = -static_cast<double>(c.row) * cell_m;
        return static_cast<float>(-fall * (east * std::sin(azimuth) + north * std::cos(azimuth)));
    });
}

} // namespace

TEST(SlopeAspect, OfPlanes) {
    for (double const azimuth : {0.0, 30.0, 90.0, 135.0, 180.0, 250.0, 270.0, 359.0}) {
        Raster<float> const dem = plane(20.0, azimuth);
        Raster<float> const slope = measure::slope(dem);
        Raster<float> const aspect = measure::aspect(dem);
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            if (dem.grid().on_border(dem.grid().at(i))) {
                EXPECT_TRUE(std::isnan(slope[i]) && std::isnan(aspect[i]));
            } else {
                EXPECT_NEAR(slope[i], 20.0, 1e-3);
                EXPECT_LT(std::fabs(std::remainder(aspect[i] - azimuth, 360.0)), 1e-2) << azimuth;
                EXPECT_TRUE(aspect[i] >= 0.0F && aspect[i] < 360.0F);
            }
        }
    }
    EXPECT_TRUE(std::isnan(measure::aspect(Raster<float>(frame(3, 3), 5.0F))[4]));
    EXPECT_EQ(measure::slope(Raster<float>(frame(3, 3), 5.0F))[4], 0.0F);
}

TEST(SlopeAspect, SlopesAreThoseThatAreCounted) {
    Raster<float> dem = rough_dem(frame(40, 30), 5);
    dem[200] = hole;
    Raster<float> const slope = measure::slope(dem);
    double sum = 0.0;
    int cells = 0;
    for (float const one : slope.values()) {
        sum += std::isnan(one) ? 0.0 : one;
        cells += std::isnan(one) ? 0 : 1;
    }
    EXPECT_NEAR(sum / cells, measure::slopes(dem).mean_deg, 1e-4);
}

TEST(Swath, OfAPlaneHasItsHeights) {
    Grid const grid{60, 40, 10.0, 1000.0, 5000.0, ""};
    auto const dem = test::raster_of(grid, [&](Cell c) { return static_cast<float>(3 * c.col + 2 * c.row); });
    std::vector<Vec2> const line = {grid.centre({5, 20}), grid.centre({55, 20})};
    measure::Swath const found = measure::swath(dem, line, {.width_m = 61.0, .step_m = 50.0});
    ASSERT_EQ(found.cells.size(), 10U);
    for (std::size_t i = 0; i < 10; ++i) {
        EXPECT_DOUBLE_EQ(found.distance_m[i], 25.0 + 50.0 * static_cast<double>(i));
        double const first = 3.0 * (5.0 + 5.0 * static_cast<double>(i));
        double const last = first + (i == 9 ? 15.0 : 12.0); // a cell on the border of two steps belongs to the next
        EXPECT_EQ(found.cells[i], i == 9 ? 42 : 35);
        EXPECT_DOUBLE_EQ(found.min[i], first + 2.0 * 17.0);
        EXPECT_DOUBLE_EQ(found.max[i], last + 2.0 * 23.0);
        EXPECT_DOUBLE_EQ(found.mean[i], 0.5 * (first + last) + 40.0);
    }
}

TEST(Swath, CountsEachCellOnceWhereTheLineIsNearest) {
    Grid const grid{50, 50, 10.0, 0.0, 500.0, ""};
    Raster<float> dem = rough_dem(grid, 9);
    dem[Cell{20, 20}] = hole;
    std::vector<Vec2> const line = {{50.0, 60.0}, {250.0, 300.0}, {430.0, 110.0}};
    double const half_m = 70.0;
    measure::Swath const found = measure::swath(dem, line, {.width_m = 2.0 * half_m, .step_m = 40.0});
    std::vector<std::int64_t> cells(found.cells.size());
    double const first_m = distance(line[0], line[1]);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Vec2 const p = grid.centre(grid.at(i));
        double best = half_m;
        double along = -1.0;
        for (int step = 0; step <= 40000; ++step) { // walks the line
            double const at = (first_m + distance(line[1], line[2])) * step / 40000.0;
            Vec2 const q = at <= first_m
                               ? line[0] + (at / first_m) * (line[1] - line[0])
                               : line[1] + ((at - first_m) / distance(line[1], line[2])) * (line[2] - line[1]);
            if (distance(p, q) < best) {
                best = distance(p, q);
                along = at;
            }
        }
        bool const is_beyond = dot(p - line[0], line[1] - line[0]) < 0.0 || dot(p - line[2], line[2] - line[1]) > 0.0;
        if (along >= 0.0 && !is_beyond && !std::isnan(dem[i])) {
            ++cells[std::min(static_cast<std::size_t>(along / 40.0), cells.size() - 1)];
        }
    }
    std::int64_t off = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        off += std::abs(cells[i] - found.cells[i]);
    }
    EXPECT_LE(off, 4); // centres within the walk's step of a limit
    EXPECT_GT(std::accumulate(found.cells.begin(), found.cells.end(), 0), 300);
}

TEST(Swath, RefusesWhatIsNoLine) {
    Raster<float> const dem(frame(3, 3), 1.0F);
    EXPECT_THROW(measure::swath(dem, {{0.0, 0.0}}), BadInput);
    EXPECT_THROW(measure::swath(dem, {{0.0, 0.0}, {0.0, 0.0}}), BadInput);
    EXPECT_THROW(measure::swath(dem, {{0.0, 0.0}, {std::nan(""), 0.0}}), BadInput);
    EXPECT_THROW(measure::swath(dem, {{0.0, 0.0}, {1.0, 0.0}}, {.width_m = 0.0}), BadParameter);
    EXPECT_THROW(measure::swath(dem, {{0.0, 0.0}, {1e9, 0.0}}, {.width_m = 1.0, .step_m = 1e-3}), BadParameter);
}

} // namespace slope_aspect_test
