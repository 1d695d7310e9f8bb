// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/comparison.hpp>

#include <limits>

#include <gtest/gtest.h>

#include <thalweg/core/run/error.hpp>

#include "pictures.hpp"
#include "small_land.hpp"

namespace comparison_test {

using namespace thalweg;
using draw::limit_of_differences;

namespace {

Raster<float> all(float difference_m) {
    return Raster<float>({40, 30, 10.0, 0.0, 300.0, ""}, difference_m);
}

} // namespace

TEST(Comparison, ColoursEndAtARoundDifference) {
    for (auto const& [most, limit] : {std::pair{0.9F, 1.0},
                                      {1.1F, 2.0},
                                      {2.0F, 2.0},
                                      {2.1F, 5.0},
                                      {5.1F, 10.0},
                                      {120.0F, 200.0},
                                      {-120.0F, 200.0},
                                      {0.0F, 1.0},
                                      {0.003F, 0.005}}) {
        EXPECT_DOUBLE_EQ(limit_of_differences(all(most)), limit) << most;
    }
    EXPECT_EQ(limit_of_differences(all(std::numeric_limits<float>::quiet_NaN())), 1.0);
}

TEST(Comparison, ColoursEndAtThe98thPercentile) {
    Raster<float> difference({53, 1, 10.0, 0.0, 10.0, ""}, 0.5F);
    difference[0] = std::numeric_limits<float>::quiet_NaN();
    difference[1] = std::numeric_limits<float>::infinity();
    difference[20] = -2.0F; // of 51 sizes the last but one
    difference[30] = 100.0F;
    EXPECT_EQ(limit_of_differences(difference), 2.0);
    difference[20] = -2.0000002F;
    EXPECT_EQ(limit_of_differences(difference), 5.0);
}

TEST(Comparison, LowerIsBlueHigherRedAndDividesHaveTheirColours) {
    Raster<float> difference = all(-100.0F);
    Raster<std::uint8_t> const shade(difference.grid(), 181);
    Mask of_dem(difference.grid());
    Mask own(difference.grid());
    for (std::int64_t row = 0; row < 30; ++row) {
        for (std::int64_t col = 20; col < 40; ++col) {
            difference[Cell{col, row}] = 100.0F;
        }
        of_dem[Cell{5, row}] = 1;
        own[Cell{10, row}] = 1;
        of_dem[Cell{15, row}] = own[Cell{15, row}] = 1;
    }
    draw::ComparisonParams params;
    params.width_px = 400;
    test::Pixels const map = test::decode(draw::differences({shade, shade, difference, of_dem, own}, params).bytes);
    EXPECT_EQ(map.width, 400U);
    EXPECT_EQ(map.height, 300U);
    EXPECT_GT(map.at(25, 150, 2), map.at(25, 150, 0) + 50);   // blue
    EXPECT_GT(map.at(350, 150, 0), map.at(350, 150, 2) + 50); // red
    EXPECT_GT(map.at(55, 150, 0), 200);
    EXPECT_LT(map.at(55, 150, 2), 60);                        // amber
    EXPECT_GT(map.at(105, 150, 2), map.at(105, 150, 1) + 60); // violet
    EXPECT_LT(map.at(155, 150, 0) + map.at(155, 150, 1) + map.at(155, 150, 2), 120);
    test::Pixels const sheet =
        test::decode(draw::comparison({shade, shade, difference, of_dem, own}, {"title", "dem.tif"}).bytes);
    EXPECT_EQ(sheet.width, 2400U);
    EXPECT_GT(sheet.height, 500U);
}

TEST(Comparison, RefusesRastersOfOtherSizes) {
    Raster<float> const difference = all(1.0F);
    Raster<std::uint8_t> const shade(difference.grid(), 181);
    Mask const divides(difference.grid());
    Mask const small({4, 4, 1.0, 0.0, 4.0, ""});
    EXPECT_THROW(draw::differences({shade, shade, difference, divides, small}), BadInput);
    EXPECT_THROW(draw::comparison({shade, shade, Raster<float>(), divides, divides}), BadInput);
    EXPECT_THROW(draw::differences({shade, shade, difference, divides, divides}, {"", "", 10}), BadParameter);
}

} // namespace comparison_test
