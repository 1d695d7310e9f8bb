// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/zones.hpp>

#include <cmath>
#include <cstdint>
#include <limits>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/flow/paths.hpp>
#include <thalweg/measure/relief/hypsometry.hpp>
#include <thalweg/measure/relief/slopes.hpp>
#include <thalweg/measure/relief/wetness.hpp>

#include "../dems.hpp"

namespace zones_test {

using namespace thalweg;

TEST(ZoneRelief, OfAWholeDemIsThatOfItsMeasures) {
    Raster<float> dem = rough_dem(test::frame(40, 30), 5);
    dem[47] = std::nanf("");
    Raster<std::int32_t> const zone(dem.grid(), 0);
    auto const drainage = flow::route(dem);
    auto const relief = measure::zone_relief(dem, zone, 2, flow::lengths_to_outlet(drainage));
    ASSERT_EQ(relief.size(), 2U);
    EXPECT_EQ(relief[0].cells, dem.cells() - 1);
    EXPECT_NEAR(relief[0].hypsometric, measure::hypsometry(dem).integral, 1e-9);
    EXPECT_NEAR(relief[0].slope_deg, measure::slopes(dem).mean_deg, 1e-4);
    double const area_m2 = static_cast<double>(dem.cells() - 1) * dem.grid().cell_m * dem.grid().cell_m;
    EXPECT_NEAR(relief[0].melton, (relief[0].z_max_m - relief[0].z_min_m) / std::sqrt(area_m2), 1e-12);
    EXPECT_EQ(relief[1].cells, 0);
    EXPECT_TRUE(std::isnan(relief[1].z_min_m));
    EXPECT_TRUE(std::isnan(relief[1].form_factor));
}

TEST(ZoneRelief, OfAColumnThatFalls) {
    Grid const grid = test::frame(3, 5);
    Raster<float> dem(grid);
    Raster<std::int32_t> zone(grid, -1);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        dem[i] = static_cast<float>(10 - 2 * grid.at(i).row + (grid.at(i).col == 1 ? 0 : 50));
        zone[i] = grid.at(i).col == 1 ? 0 : -1;
    }
    auto const relief = measure::zone_relief(dem, zone, 1, flow::lengths_to_outlet(flow::route(dem)));
    double const cell = grid.cell_m;
    EXPECT_EQ(relief[0].z_min_m, 2.0);
    EXPECT_EQ(relief[0].z_max_m, 10.0);
    EXPECT_EQ(relief[0].z_mean_m, 6.0);
    EXPECT_EQ(relief[0].hypsometric, 0.5);
    EXPECT_NEAR(relief[0].melton, 8.0 / (cell * std::sqrt(5.0)), 1e-12);
    EXPECT_NEAR(relief[0].flow_length_m, 4.0 * cell, 1e-9);
    EXPECT_NEAR(relief[0].form_factor, 5.0 / 16.0, 1e-12);
    EXPECT_NEAR(relief[0].slope_deg, std::atan(2.0 / cell) * 180.0 / std::acos(-1.0), 1e-9);
    EXPECT_THROW(measure::zone_relief(dem, zone, 0, Raster<double>(grid)), BadInput);
    EXPECT_THROW(measure::zone_relief(dem, zone, 1, Raster<double>(test::frame(2, 5))), BadInput);
}

TEST(Wetness, IsTheLogarithmOfAreaOverSlope) {
    Grid const grid = test::frame(4, 4);
    Raster<float> dem(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        dem[i] = static_cast<float>(grid.at(i).row * 3);
    }
    Raster<double> const area(grid, 7.0);
    Raster<double> const index = measure::wetness(dem, area);
    EXPECT_NEAR(index[grid.index({1, 1})], std::log(7.0 * grid.cell_m / (3.0 / grid.cell_m)), 1e-12);
    EXPECT_TRUE(std::isnan(index[grid.index({0, 1})]));
    Raster<float> const level(grid);
    EXPECT_NEAR(measure::wetness(level, area)[grid.index({2, 2})], std::log(7.0 * grid.cell_m / 0.001), 1e-12);
    EXPECT_THROW(measure::wetness(dem, area, {0.0}), BadParameter);
    EXPECT_THROW(measure::wetness(dem, Raster<double>(test::frame(3, 4))), BadInput);
}

} // namespace zones_test
