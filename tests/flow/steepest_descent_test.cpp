// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/direction.hpp>

#include <gtest/gtest.h>
#include <measure/dems.hpp>

namespace steepest_descent_test {

using namespace thalweg;
using flow::Descent;
using flow::Direction;
using flow::steepest_descent;

TEST(SteepestDescent, LeavesWhereNothingIsLower) {
    for (Raster<float> const& dem : {dem_of(1, {4}), dem_of(3, {2, 2, 2, 2, 2, 2, 2, 2, 2}), dem_of(2, {1, hole})}) {
        Descent const down = steepest_descent(dem, {0, 0});
        EXPECT_EQ(down.direction, Direction::leaves);
        EXPECT_EQ(down.slope, 0.0);
    }
    EXPECT_EQ(steepest_descent(dem_of(2, {hole, 1}), {0, 0}).direction, Direction::leaves);
}

TEST(SteepestDescent, DividesByLengthAndTakesTheFirstOfEqualSlopes) {
    Raster<float> dem(frame(3, 3), 9.0F);
    dem[4] = 5.0F;
    dem[5] = 4.0F;
    dem[8] = 3.5F;
    Descent const diagonal = steepest_descent(dem, {1, 1});
    EXPECT_EQ(diagonal.direction, Direction::south_east);
    EXPECT_DOUBLE_EQ(diagonal.slope, 1.5 / std::sqrt(2.0));
    dem[8] = 9.0F;
    dem[7] = 4.0F;
    Descent const down = steepest_descent(dem, {1, 1});
    EXPECT_EQ(down.direction, Direction::east);
    EXPECT_EQ(down.slope, 1.0);
}

} // namespace steepest_descent_test
