// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/uplift/uplift_pattern.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

namespace uplift_pattern_test {

namespace {

using namespace thalweg;
using surface::uplift_pattern;
using surface::UpliftPattern;
using surface::UpliftPatternParams;
using test::frame_below;
using test::on_threads;

UpliftPatternParams of(UpliftPattern pattern, double strike_deg = 0.0) {
    return {.pattern = pattern, .wave_m = 3000.0, .strike_deg = strike_deg};
}

std::vector<UpliftPattern> const all = {UpliftPattern::tilt, UpliftPattern::domes, UpliftPattern::blocks,
                                        UpliftPattern::folds};

/// Mean absolute difference of the logarithm between cells some steps apart.
double difference(Raster<float> const& uplift, std::int64_t east, std::int64_t south) {
    double sum = 0.0;
    double count = 0.0;
    for (std::int64_t row = 0; row + south < uplift.height(); ++row) {
        for (std::int64_t col = 0; col + east < uplift.width(); ++col) {
            sum += std::fabs(std::log(static_cast<double>(uplift[Cell{col + east, row + south}])) -
                             std::log(static_cast<double>(uplift[Cell{col, row}])));
            count += 1.0;
        }
    }
    return sum / count;
}

} // namespace

TEST(UpliftPattern, LiesBetweenItsBounds) {
    for (UpliftPattern const pattern : all) {
        for (double const contrast : {1.0, 4.0, 100.0}) {
            UpliftPatternParams params = of(pattern, 33.0);
            params.contrast = contrast;
            Raster<float> const uplift = uplift_pattern(frame_below(90, 70, 100.0), params);
            auto const [low, high] = std::minmax_element(uplift.values().begin(), uplift.values().end());
            EXPECT_GE(*low, static_cast<float>(1.0 / std::sqrt(contrast)) * (1.0F - 1e-5F));
            EXPECT_LE(*high, static_cast<float>(std::sqrt(contrast)) * (1.0F + 1e-5F));
            EXPECT_GE(std::log(*high / *low), 0.6 * std::log(contrast) - 1e-5);
        }
    }
}

// Along the strike uplift hardly changes, across it does; domes have no strike.
TEST(UpliftPattern, FollowsItsStrike) {
    for (UpliftPattern const pattern : {UpliftPattern::tilt, UpliftPattern::blocks, UpliftPattern::folds}) {
        Raster<float> const northward = uplift_pattern(frame_below(120, 120, 100.0), of(pattern, 0.0));
        EXPECT_GT(difference(northward, 6, 0), 2.0 * difference(northward, 0, 6));
        Raster<float> const eastward = uplift_pattern(frame_below(120, 120, 100.0), of(pattern, 90.0));
        EXPECT_GT(difference(eastward, 0, 6), 2.0 * difference(eastward, 6, 0));
    }
    Raster<float> const domes = uplift_pattern(frame_below(120, 120, 100.0), of(UpliftPattern::domes, 0.0));
    EXPECT_EQ(domes.values()[77],
              uplift_pattern(frame_below(120, 120, 100.0), of(UpliftPattern::domes, 90.0)).values()[77]);
    EXPECT_NEAR(difference(domes, 6, 0) / difference(domes, 0, 6), 1.0, 0.4);
}

// Cells of half the size see the same uplift, four in the place of one.
TEST(UpliftPattern, IsOnePlaceAtAnyCellSize) {
    for (UpliftPattern const pattern : all) {
        Raster<float> const coarse = uplift_pattern(frame_below(60, 48, 200.0), of(pattern, 20.0));
        Raster<float> const fine = uplift_pattern(frame_below(120, 96, 100.0), of(pattern, 20.0));
        double off = 0.0;
        for (std::int64_t i = 0; i < coarse.cells(); ++i) {
            Cell const c = coarse.grid().at(i);
            double const mean = 0.25 * (static_cast<double>(fine[Cell{2 * c.col, 2 * c.row}]) +
                                        static_cast<double>(fine[Cell{2 * c.col + 1, 2 * c.row}]) +
                                        static_cast<double>(fine[Cell{2 * c.col, 2 * c.row + 1}]) +
                                        static_cast<double>(fine[Cell{2 * c.col + 1, 2 * c.row + 1}]));
            off += std::fabs(mean / static_cast<double>(coarse[i]) - 1.0);
        }
        EXPECT_LT(off / static_cast<double>(coarse.cells()), 0.02); // but at faults
    }
}

TEST(UpliftPattern, SameForAnyThreadsOtherForAnotherSeed) {
    thalweg::Run const alone = on_threads(1);
    for (UpliftPattern const pattern : all) {
        UpliftPatternParams params = of(pattern, 10.0);
        Raster<float> const one = uplift_pattern(frame_below(70, 50, 120.0), params, alone);
        Raster<float> const many = uplift_pattern(frame_below(70, 50, 120.0), params);
        EXPECT_TRUE(std::equal(one.values().begin(), one.values().end(), many.values().begin()));
        params.seed = 8;
        Raster<float> const other = uplift_pattern(frame_below(70, 50, 120.0), params);
        bool const same = std::equal(one.values().begin(), one.values().end(), other.values().begin());
        EXPECT_EQ(same, pattern == UpliftPattern::tilt);
    }
    EXPECT_NE(surface::random_strike_deg(7), surface::random_strike_deg(8));
}

// A seed has one pattern, whose bytes it is; many seeds have each of the three.
TEST(UpliftPattern, OfASeed) {
    std::array<int, 5> seeds{};
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        ++seeds[static_cast<std::size_t>(surface::uplift_pattern_of_seed(seed))];
    }
    EXPECT_EQ(seeds[static_cast<std::size_t>(UpliftPattern::tilt)], 0);
    for (UpliftPattern const pattern : {UpliftPattern::domes, UpliftPattern::blocks, UpliftPattern::folds}) {
        EXPECT_GT(seeds[static_cast<std::size_t>(pattern)], 75);
    }
    Grid const grid = frame_below(20, 20, 300.0);
    UpliftPatternParams params = of(UpliftPattern::seed, 20.0);
    Raster<float> const by_seed = uplift_pattern(grid, params);
    params.pattern = surface::uplift_pattern_of_seed(params.seed);
    Raster<float> const of_it = uplift_pattern(grid, params);
    EXPECT_TRUE(std::equal(by_seed.values().begin(), by_seed.values().end(), of_it.values().begin()));
}

TEST(UpliftPattern, RefusesWhatCannotBe) {
    Grid const grid = frame_below(4, 4, 30.0);
    EXPECT_THROW(uplift_pattern(grid, {.contrast = 0.9}), BadParameter);
    EXPECT_THROW(uplift_pattern(grid, {.wave_m = 0.0}), BadParameter);
    EXPECT_THROW(uplift_pattern(grid, {.strike_deg = std::numeric_limits<double>::quiet_NaN()}), BadParameter);
}

} // namespace uplift_pattern_test
