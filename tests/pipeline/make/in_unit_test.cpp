// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/internal/file_values.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace in_unit_test {

namespace {

using namespace thalweg;

Raster<float> row_of(std::vector<float> const& heights) {
    Raster<float> dem(Grid{static_cast<std::int64_t>(heights.size()), 1, 1.0, 0.0, 1.0, ""});
    for (std::size_t i = 0; i < heights.size(); ++i) {
        dem[static_cast<std::int64_t>(i)] = heights[i];
    }
    return dem;
}

} // namespace

TEST(InUnit, NoHeights) {
    float const nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(std::isnan(pipeline::in_unit(row_of({nan}), HeightUnit::foot)[0]));
}

TEST(InUnit, MetresStay) {
    EXPECT_EQ(pipeline::in_unit(row_of({1.5F, -2.0F}), HeightUnit::metre)[1], -2.0F);
}

TEST(InUnit, ExactFeet) {
    Raster<float> const feet = pipeline::in_unit(row_of({0.3048F, 304.8F, -0.3048F, 0.0F}), HeightUnit::foot);
    EXPECT_FLOAT_EQ(feet[0], 1.0F);
    EXPECT_FLOAT_EQ(feet[1], 1000.0F); // 304.8 is not a float
    EXPECT_FLOAT_EQ(feet[2], -1.0F);
    EXPECT_EQ(feet[3], 0.0F);
}

TEST(InUnit, NeighboursOneUlpApartStayApart) {
    std::vector<float> chain{1.99F}; // floats lie closer together here than at 6.53
    for (int i = 0; i < 1000; ++i) {
        chain.push_back(std::nextafterf(chain.back(), 10.0F));
    }
    Raster<float> const feet = pipeline::in_unit(row_of(chain), HeightUnit::foot);
    for (std::int64_t i = 1; i < feet.cells(); ++i) {
        EXPECT_LT(feet[i - 1], feet[i]);
    }
}

RC_GTEST_PROP(InUnit, TheOrderStays, (std::vector<int> numbers)) {
    std::vector<float> heights{0.0F};
    for (int const n : numbers) {
        heights.push_back(static_cast<float>(n % 100000) * 0.37F);
    }
    Raster<float> const dem = row_of(heights);
    Raster<float> const feet = pipeline::in_unit(dem, HeightUnit::foot);
    for (std::int64_t i = 1; i < dem.cells(); ++i) {
        RC_ASSERT((dem[i - 1] < dem[i]) == (feet[i - 1] < feet[i]));
        RC_ASSERT((dem[i - 1] == dem[i]) == (feet[i - 1] == feet[i]));
        RC_ASSERT(std::fabs(static_cast<double>(feet[i]) * 0.3048 - static_cast<double>(dem[i])) < 0.01);
    }
}

} // namespace in_unit_test
