// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/slope_area.hpp>

#include <cmath>

#include <gtest/gtest.h>

#include <thalweg/core/run/error.hpp>

#include "graded_land.hpp"

namespace slope_area_ratio_test {

using namespace thalweg;
using flow::route;
using measure::slope_area_ratio;

TEST(SlopeAreaRatio, RefusesNonsense) {
    Raster<float> const dem = rough_dem(frame(9, 9), 1);
    flow::FlowField const drainage = route(dem);
    EXPECT_THROW(slope_area_ratio(dem, drainage, {.hillslope_from = 0}), BadParameter);
    EXPECT_THROW(slope_area_ratio(dem, drainage, {.hillslope_to = 3}), BadParameter);
    EXPECT_THROW(slope_area_ratio(dem, drainage, {.channel_from = 0}), BadParameter);
    EXPECT_THROW(slope_area_ratio(dem, drainage, {.channel_to = 3000}), BadParameter);
    EXPECT_THROW(slope_area_ratio(Raster<float>(frame(8, 9)), drainage), BadInput);
}

TEST(SlopeAreaRatio, UnknownWithoutChannelsOrSlopes) {
    Raster<float> const small = rough_dem(frame(9, 9), 1);
    EXPECT_TRUE(std::isnan(slope_area_ratio(small, route(small))));
    Raster<float> const level(frame(200, 200), 1.0F);
    EXPECT_TRUE(std::isnan(slope_area_ratio(level, route(level))));
}

// Four planes by their slope: which cells count follows from the areas alone.
TEST(SlopeAreaRatio, IsTheMeanSlopeOfEither) {
    Raster<float> dem(frame(40, 40));
    flow::FlowField drainage = route(dem);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Cell const at = dem.grid().at(i);
        bool const west = at.col < 20;
        dem[i] = static_cast<float>(at.row) * (west ? 0.2F : 0.6F);
        drainage.area_cells[i] = at.col < 15 ? 5000 : at.col < 25 ? 100 : 5;
    }
    EXPECT_NEAR(slope_area_ratio(dem, drainage), 0.2 / 0.6, 1e-6);
}

} // namespace slope_area_ratio_test
