// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/relief.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/measure/relief/hypsometry.hpp>
#include <thalweg/measure/relief/slopes.hpp>

#include "graded_land.hpp"

namespace relief_test {

using namespace thalweg;
using flow::route;
using measure::local_extremes;
using measure::LocalExtremes;
using measure::perched;
using measure::Relief;
using measure::relief;
using measure::statistics;

namespace {

using test::on_threads;

Relief relief_of(Raster<float> const& dem, Run const& run = {}) {
    return relief(dem, route(dem, run), statistics(dem, run), {}, run);
}

} // namespace

TEST(LocalExtremes, OnlyWhereAllNeighboursAre) {
    EXPECT_EQ(local_extremes(Raster<float>{}).cells, 0);
    EXPECT_EQ(local_extremes(Raster<float>(frame(2, 9), 1.0F)).cells, 0);
    LocalExtremes const level = local_extremes(Raster<float>(frame(4, 4), 1.0F));
    EXPECT_EQ(level.cells, 4);
    EXPECT_EQ(level.pits + level.peaks, 0);
    EXPECT_EQ(local_extremes(dem_of(3, {1, 1, 1, 1, 0, 1, 1, 1, 1})).pits, 1);
    EXPECT_EQ(local_extremes(dem_of(3, {1, 1, 1, 1, 2, 1, 1, 1, 1})).peaks, 1);
    EXPECT_EQ(local_extremes(dem_of(3, {1, 1, 1, 1, 0, 1, 1, 1, 0})).pits, 0);
    EXPECT_EQ(local_extremes(dem_of(3, {1, 1, 1, 1, 0, 1, 1, 1, hole})).cells, 0);
}

TEST(LocalExtremes, AsCountedCellByCell) {
    ASSERT_TRUE(rc::check("pits and peaks are cells below or above all eight", [] {
        Raster<float> dem = *gen_dem(15, 10);
        LocalExtremes wanted;
        for (std::int64_t r = 1; r + 1 < dem.height(); ++r) {
            for (std::int64_t c = 1; c + 1 < dem.width(); ++c) {
                float const z = dem[Cell{c, r}];
                bool all = !std::isnan(z);
                bool pit = true;
                bool peak = true;
                for (Cell const step : d8_steps) {
                    float const there = dem[Cell{c + step.col, r + step.row}];
                    all = all && !std::isnan(there);
                    pit = pit && there > z;
                    peak = peak && there < z;
                }
                wanted.cells += all ? 1 : 0;
                wanted.pits += all && pit ? 1 : 0;
                wanted.peaks += all && peak ? 1 : 0;
            }
        }
        LocalExtremes const found = local_extremes(dem);
        RC_ASSERT(found.cells == wanted.cells);
        RC_ASSERT(found.pits == wanted.pits);
        RC_ASSERT(found.peaks == wanted.peaks);
    }));
}

TEST(Perched, AboveTheLowestOfTheSecondRing) {
    Raster<float> dem(frame(7, 7), 5.0F);
    std::vector<std::int64_t> const middle{dem.grid().index({3, 3})};
    EXPECT_TRUE(perched(dem, middle, 0.0).empty());
    dem[Cell{3, 4}] = 0.0F; // the first ring says nothing
    EXPECT_TRUE(perched(dem, middle, 0.0).empty());
    dem[Cell{6, 3}] = 0.0F; // nor does the third
    EXPECT_TRUE(perched(dem, middle, 0.0).empty());
    for (std::int64_t row = 1; row <= 5; ++row) {
        for (std::int64_t col = 1; col <= 5; ++col) {
            if (std::max(std::abs(row - 3), std::abs(col - 3)) == 2) {
                Raster<float> other = dem;
                other[Cell{col, row}] = 4.0F;
                EXPECT_EQ(perched(other, middle, 0.9), middle);
                EXPECT_TRUE(perched(other, middle, 1.0).empty());
            }
        }
    }
    EXPECT_TRUE(perched(Raster<float>(frame(1, 1), 1.0F), std::vector<std::int64_t>{0}, 0.0).empty());
    EXPECT_TRUE(perched(Raster<float>(frame(7, 7), hole), middle, 0.0).empty());
}

TEST(Perched, RefusesNonsense) {
    Raster<float> const dem(frame(3, 3), 1.0F);
    EXPECT_THROW(perched(dem, std::vector<std::int64_t>{9}, 1.0), BadInput);
    EXPECT_THROW(perched(dem, std::vector<std::int64_t>{-1}, 1.0), BadInput);
    EXPECT_THROW(perched(dem, {}, -1.0), BadParameter);
    EXPECT_THROW(perched(dem, {}, std::nan("")), BadParameter);
}

TEST(Relief, OfLittleLandIsUnknownNotWrong) {
    for (Raster<float> const& dem : {dem_of(1, {1.0F}), dem_of(2, {hole, 2.0F}), Raster<float>(frame(40, 40), 1.0F)}) {
        Relief const found = relief_of(dem);
        EXPECT_FALSE(found.slope_area);
        EXPECT_FALSE(found.chi);
        EXPECT_EQ(found.hypsometric_integral, 0.5);
        EXPECT_TRUE(std::isnan(found.valleys_over_ridges));
        EXPECT_EQ(found.drainage_density, dem.cells() < 200 ? 0.0 : found.drainage_density);
        for (measure::ReliefMetric const& figure : measure::relief_metrics()) {
            EXPECT_FALSE(std::isinf(figure.of(found))) << figure.key;
        }
    }
}

TEST(Relief, RefusesWhatIsNotOfOneLand) {
    Raster<float> const dem = rough_dem(frame(9, 9), 1);
    Raster<float> const other = rough_dem(frame(8, 9), 1);
    EXPECT_THROW(relief(dem, route(dem), statistics(other)), BadInput);
    EXPECT_THROW(relief(dem, route(other), statistics(dem)), BadInput);
    EXPECT_THROW(relief(dem, route(dem), statistics(dem), {.support_cells = 0}), BadParameter);
}

TEST(Relief, IsWhatItsPartsFind) {
    GradedLand const land = graded_land(frame(160, 200), 2, 0.45, 0.5);
    Relief const found = relief_of(land.dem);
    flow::FlowField const drainage = route(land.dem);
    EXPECT_EQ(found.slopes.mean_deg, measure::slopes(land.dem).mean_deg);
    EXPECT_EQ(found.slope_area->exponent, measure::slope_area(land.dem, drainage)->exponent);
    EXPECT_EQ(found.chi->r2, measure::chi(land.dem, drainage)->r2);
    EXPECT_NEAR(found.hypsometric_integral, measure::hypsometry(land.dem).integral, 1e-9);
    measure::Geomorphons const forms = measure::geomorphons(land.dem);
    EXPECT_EQ(found.forms, forms.shares);
    EXPECT_DOUBLE_EQ(found.valleys_over_ridges,
                     static_cast<double>(forms.cells[8]) / static_cast<double>(forms.cells[2]));
    double length = 0.0;
    for (std::int64_t i = 0; i < drainage.direction.cells(); ++i) {
        if (drainage.area_cells[i] >= 200 && goes_on(drainage.direction[i])) {
            length += is_diagonal(drainage.direction[i]) ? std::sqrt(2.0) : 1.0;
        }
    }
    EXPECT_NEAR(found.drainage_density, length / 32000.0, 1e-12);
    EXPECT_NEAR(found.scaled_density, found.drainage_density * std::sqrt(200.0), 1e-12);
}

// Heights and cells times the same number: no figure changes, but for those that ask for metres.
TEST(Relief, HasNoScale) {
    GradedLand const land = graded_land(frame(120, 120), 6, 0.45, 0.5);
    Grid large = land.dem.grid();
    large.cell_m = 64.0;
    Raster<float> enlarged(large);
    for (std::int64_t i = 0; i < enlarged.cells(); ++i) {
        enlarged[i] = 64.0F * land.dem[i];
    }
    Relief const a = relief_of(land.dem);
    Relief const b = relief_of(enlarged);
    for (measure::ReliefMetric const& figure : measure::relief_metrics()) {
        bool const in_metres = figure.key.starts_with("gradient_") || figure.key.starts_with("promin") ||
                               figure.key == "isolation" || figure.key == "slope_spread" ||
                               figure.key == "gentle_away" || figure.key == "half_way_height" ||
                               figure.key == "canals" || figure.key == "steepest_drop";
        if (figure.key != "theta" && figure.key != "theta_r2" && !in_metres) { // the edges of its bins are in m2
            bool const unknown = std::isnan(figure.of(a)) && std::isnan(figure.of(b));
            EXPECT_TRUE(unknown || std::fabs(figure.of(a) - figure.of(b)) < 1e-6) << figure.key;
        }
    }
    EXPECT_NEAR(-a.slope_area->exponent, -b.slope_area->exponent, 0.05);
}

TEST(Relief, TotalVariation) {
    std::array<double, measure::form_count> one{};
    std::array<double, measure::form_count> other{};
    one[0] = 1.0;
    other[3] = 1.0;
    EXPECT_EQ(measure::total_variation(one, one), 0.0);
    EXPECT_EQ(measure::total_variation(one, other), 1.0);
    other[0] = 0.5;
    other[3] = 0.5;
    EXPECT_EQ(measure::total_variation(one, other), 0.5);
}

TEST(Relief, SameBitsForAnyThreads) {
    Raster<float> const dem = rough_dem(frame(260, 300), 11);
    thalweg::Run const one = on_threads(1);
    thalweg::Run const five = on_threads(5);
    Relief const a = relief_of(dem, one);
    Relief const b = relief_of(dem, five);
    for (measure::ReliefMetric const& figure : measure::relief_metrics()) {
        bool const unknown = std::isnan(figure.of(a)) && std::isnan(figure.of(b));
        EXPECT_TRUE(unknown || figure.of(a) == figure.of(b)) << figure.key;
    }
}

} // namespace relief_test
