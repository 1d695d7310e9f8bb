// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/scatter.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/skeleton/random_fields.hpp>

#include "fields.hpp"

namespace attract_test {

using namespace thalweg;
using skeleton::attract;
using skeleton::Falloff;
using skeleton::shift_mean;

TEST(Attract, RefusesACentreOffTheGridAndNoRadius) {
    Raster<float> const dem(frame(5, 4), 10.0F);
    EXPECT_THROW(attract(dem, {{5, 0}, 20.0, 2.0}), BadParameter);
    EXPECT_THROW(attract(dem, {{0, -1}, 20.0, 2.0}), BadParameter);
    EXPECT_THROW(attract(dem, {{0, 0}, 20.0, 0.0}), BadParameter);
    EXPECT_THROW(attract(dem, {{0, 0}, std::nan(""), 1.0}), BadParameter);
}

TEST(Attract, FollowsTheEquation) {
    Raster<float> dem(frame(21, 17), 10.0F);
    dem[Cell{9, 8}] = std::numeric_limits<float>::quiet_NaN();
    for (auto const falloff : {Falloff::continuous, Falloff::literal}) {
        auto const pulled = attract(dem, {{8, 8}, 110.0, 5.0, falloff});
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            Cell const cell = dem.grid().at(i);
            double const d = std::hypot(static_cast<double>(cell.col - 8), static_cast<double>(cell.row - 8));
            double const literal = std::exp(-d * d / 25.0);
            double const pull =
                falloff == Falloff::literal ? literal : (literal - std::exp(-1.0)) / (1.0 - std::exp(-1.0));
            if (std::isnan(dem[i])) {
                EXPECT_TRUE(std::isnan(pulled[i]));
            } else {
                EXPECT_NEAR(pulled[i], d <= 5.0 ? 10.0 + pull * 100.0 : 10.0, 1e-5);
            }
        }
        EXPECT_EQ((pulled[Cell{8, 8}]), 110.0F);
        // At the radius itself, (3, 4) away: a step of 100/e as printed, none by default.
        EXPECT_NEAR((pulled[Cell{11, 12}]), falloff == Falloff::literal ? 10.0 + 100.0 * std::exp(-1.0) : 10.0, 1e-5);
    }
}

TEST(ShiftMean, MovesAllHeightsAlike) {
    Raster<float> dem(frame(2, 2), 0.0F);
    dem[1] = 4.0F;
    dem[2] = std::numeric_limits<float>::quiet_NaN();
    dem[3] = 8.0F;
    auto const moved = shift_mean(dem, 100.0);
    EXPECT_EQ(moved[0], 96.0F);
    EXPECT_EQ(moved[1], 100.0F);
    EXPECT_TRUE(std::isnan(moved[2]));
    EXPECT_EQ(moved[3], 104.0F);
    EXPECT_THROW(shift_mean(dem, std::nan("")), BadParameter);
    EXPECT_EQ(shift_mean(Raster<float>{}, 1.0).cells(), 0);
}

} // namespace attract_test
