// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/slope_area.hpp>

#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/route.hpp>

#include "graded_land.hpp"

namespace slope_area_test {

using namespace thalweg;
using flow::route;
using measure::chi;
using measure::slope_area;
using measure::slope_area_ratio;

namespace {

Grid cells_of_30_m(std::int64_t width, std::int64_t height) {
    Grid grid = frame(width, height);
    grid.cell_m = 30.0;
    return grid;
}

} // namespace

TEST(SlopeArea, NoneOfTooLittleLand) {
    for (Raster<float> const& dem : {dem_of(1, {1.0F}), dem_of(2, {hole, hole}), Raster<float>(frame(8, 8), 1.0F)}) {
        EXPECT_FALSE(slope_area(dem, route(dem)));
        EXPECT_FALSE(chi(dem, route(dem)));
    }
    Raster<float> const level(frame(200, 200), 1.0F);
    EXPECT_FALSE(slope_area(level, route(level)));
    EXPECT_FALSE(chi(level, route(level)));
}

TEST(SlopeArea, RefusesNonsense) {
    Raster<float> const dem = rough_dem(frame(9, 9), 1);
    flow::FlowField const drainage = route(dem);
    EXPECT_THROW(slope_area(dem, drainage, {.support_cells = 0}), BadParameter);
    EXPECT_THROW(slope_area(dem, drainage, {.bins_per_decade = 0}), BadParameter);
    EXPECT_THROW(slope_area(dem, drainage, {.least_places = 0}), BadParameter);
    EXPECT_THROW(slope_area(dem, drainage, {.least_bins = 2}), BadParameter);
    EXPECT_THROW(slope_area(Raster<float>(frame(8, 9)), drainage), BadInput);
    EXPECT_THROW(chi(dem, drainage, {.theta = -0.1}), BadParameter);
    EXPECT_THROW(chi(dem, drainage, {.theta = std::nan("")}), BadParameter);
    EXPECT_THROW(chi(dem, drainage, {.support_cells = 0}), BadParameter);
    EXPECT_THROW(chi(dem, drainage, {.least_cells = 2}), BadParameter);
    EXPECT_THROW(chi(dem, drainage, {.most_stems = 0}), BadParameter);
    EXPECT_THROW(chi(Raster<float>(frame(8, 9)), drainage), BadInput);
}

// Rivers graded with a known theta have it, and are straight where the way is counted in chi.
TEST(SlopeArea, RecoversTheta) {
    ASSERT_TRUE(rc::check("theta within 0.01, k within 5 %, chi straight", [] {
        double const theta = *rc::gen::element(0.2, 0.35, 0.45, 0.55, 0.8);
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        GradedLand const land = graded_land(cells_of_30_m(120, 160), seed, theta, 20.0);
        auto const law = slope_area(land.dem, land.drainage, {.support_cells = 20});
        RC_ASSERT(law.has_value());
        RC_ASSERT(std::fabs(-law->exponent - theta) < 0.01);
        RC_ASSERT(law->r2 > 0.999);
        RC_ASSERT(std::fabs(law->coefficient / 20.0 - 1.0) < 0.15);
        auto const straight = chi(land.dem, land.drainage, {.theta = theta, .support_cells = 20});
        RC_ASSERT(straight.has_value());
        RC_ASSERT(straight->r2 > 0.99999);
        RC_ASSERT(std::fabs(straight->main_steepness / 20.0 - 1.0) < 0.001);
        auto const bent = chi(land.dem, land.drainage, {.theta = theta + 0.5, .support_cells = 20});
        RC_ASSERT(bent->r2 < straight->r2);
    }));
}

// Heights in whole metres, and with noise as SRTM has it, leave theta where it is: no step's logarithm is taken.
TEST(SlopeArea, WholeMetresAndNoiseDoNotBendIt) {
    for (double const theta : {0.35, 0.45, 0.55}) {
        GradedLand land = graded_land(cells_of_30_m(400, 400), 9, theta, 20.0);
        for (std::int64_t i = 0; i < land.dem.cells(); ++i) {
            double const noise = unit(random_word(3, static_cast<std::uint64_t>(i))) - 0.5;
            land.dem[i] = static_cast<float>(std::round(static_cast<double>(land.dem[i]) + 4.0 * noise));
        }
        auto const law = slope_area(land.dem, land.drainage, {.support_cells = 20});
        ASSERT_TRUE(law);
        EXPECT_NEAR(-law->exponent, theta, 0.03);
        EXPECT_GT(law->r2, 0.98);
        EXPECT_GT(law->exponent_error, 0.0);
    }
}

// By its own steepest descent a graded land has nearly the rivers it was made with.
TEST(SlopeArea, OfTheLandsOwnDrainage) {
    GradedLand const land = graded_land(cells_of_30_m(300, 300), 4, 0.45, 20.0);
    auto const law = slope_area(land.dem, route(land.dem));
    ASSERT_TRUE(law);
    EXPECT_NEAR(-law->exponent, 0.45, 0.1);
}

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

} // namespace slope_area_test
