// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/hypsometry.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

#include "dems.hpp"

namespace hypsometry_test {

using namespace thalweg;
using measure::hypsometry;
using measure::Hypsometry;

namespace {

using test::has;
using test::message_of;
using test::on_threads;

void hold_to_definition(Raster<float> const& dem) {
    std::vector<double> heights;
    long double sum = 0.0L;
    for (float const z : dem.values()) {
        if (!std::isnan(z)) {
            heights.push_back(static_cast<double>(z));
            sum += static_cast<long double>(z);
        }
    }
    std::sort(heights.rbegin(), heights.rend());
    Hypsometry const fast = hypsometry(dem);
    RC_ASSERT(fast.points.size() == 101U);
    for (std::size_t k = 0; k <= 100; ++k) {
        RC_ASSERT(fast.points[k].share_above == static_cast<double>(k) / 100.0);
        RC_ASSERT(fast.points[k].z == heights[k * (heights.size() - 1) / 100]);
    }
    long double const range = static_cast<long double>(heights.front()) - static_cast<long double>(heights.back());
    auto const n = static_cast<long double>(heights.size());
    double const integral =
        range > 0.0L ? static_cast<double>((sum / n - static_cast<long double>(heights.back())) / range) : 0.5;
    RC_ASSERT(std::fabs(fast.integral - integral) < 1e-9);
}

} // namespace

TEST(Hypsometry, OneHeight) {
    Hypsometry const one = hypsometry(dem_of(1, {-3.5F}));
    EXPECT_EQ(one.integral, 0.5);
    ASSERT_EQ(one.points.size(), 101U);
    EXPECT_EQ(one.points.front().z, -3.5);
    EXPECT_EQ(one.points.back().z, -3.5);
    EXPECT_EQ(hypsometry(dem_of(2, {0.0F, -0.0F, 0.0F, -0.0F})).integral, 0.5);
}

TEST(Hypsometry, RefusesNoHeightsAndInfiniteOnes) {
    EXPECT_THROW(hypsometry(Raster<float>{}), BadInput);
    EXPECT_THROW(hypsometry(dem_of(2, {hole, hole})), BadInput);
    EXPECT_TRUE(has(message_of<BadInput>([&] {
                        hypsometry(dem_of(2, {1.0F, 2.0F, 3.0F, -std::numeric_limits<float>::infinity()}));
                    }),
                    "column 1, row 1"));
}

TEST(Hypsometry, HundredAndOneHeightsAreTheCurve) {
    std::vector<float> heights;
    for (int i = 0; i <= 100; ++i) {
        heights.push_back(static_cast<float>((i * 37) % 101));
        heights.push_back(hole);
    }
    Hypsometry const found = hypsometry(dem_of(2, heights));
    for (std::size_t k = 0; k <= 100; ++k) {
        EXPECT_EQ(found.points[k].z, 100.0 - static_cast<double>(k));
    }
    EXPECT_EQ(found.integral, 0.5);
}

TEST(Hypsometry, AsSorted) {
    ASSERT_TRUE(rc::check("heights of the sorted places, and the mean's share", [] {
        Raster<float> dem = *gen_dem(12, 60);
        dem[0] = 0.0F; // one cell at least has a height
        hold_to_definition(dem);
        Raster<float> rough = rough_dem(dem.grid(), *rc::gen::arbitrary<std::uint64_t>());
        float const scale = *rc::gen::element(1e-38F, 1e-3F, 1.0F, 1e4F, 3e38F);
        for (float& z : rough.values()) {
            z = (z - 0.3F) * scale;
        }
        hold_to_definition(rough);
    }));
}

TEST(Hypsometry, SameBitsForAnyThreads) {
    Raster<float> dem = rough_dem(frame(1500, 1500), 11);
    for (std::int64_t i = 0; i < dem.cells(); i += 7) {
        dem[i] = hole;
    }
    thalweg::Run const one = on_threads(1);
    thalweg::Run const four = on_threads(4);
    Hypsometry const a = hypsometry(dem, one);
    Hypsometry const b = hypsometry(dem, four);
    EXPECT_EQ(a.integral, b.integral);
    for (std::size_t k = 0; k <= 100; ++k) {
        EXPECT_EQ(a.points[k].z, b.points[k].z);
    }
}

} // namespace hypsometry_test
