// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/direction.hpp>

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>
#include <measure/dems.hpp>

namespace direction_test {

using namespace thalweg;
using flow::Descent;
using flow::Direction;
using flow::direction_of;
using flow::steepest_descent;

TEST(Direction, LeadsNowhereWithoutDataAndWhereWaterLeaves) {
    EXPECT_FALSE(goes_on(Direction::leaves));
    EXPECT_FALSE(goes_on(Direction::no_data));
    Grid grid;
    grid.width = grid.height = 1;
    EXPECT_EQ(flow::receiver(Raster<Direction>(grid, Direction::leaves), 0), -1);
    EXPECT_EQ(flow::receiver(Raster<Direction>(grid, Direction::no_data), 0), -1);
}

TEST(Direction, OppositesLeadBack) {
    Grid grid;
    grid.width = grid.height = 3;
    for (std::size_t k = 0; k < d8_steps.size(); ++k) {
        Direction const d = direction_of(k);
        EXPECT_TRUE(goes_on(d));
        Raster<Direction> direction(grid, opposite(d));
        direction[4] = d;
        std::int64_t const next = flow::receiver(direction, 4);
        EXPECT_EQ(next, grid.index({1 + d8_steps[k].col, 1 + d8_steps[k].row}));
        EXPECT_EQ(flow::receiver(direction, next), 4);
        EXPECT_EQ(is_diagonal(d), d8_steps[k].col != 0 && d8_steps[k].row != 0);
    }
}

// Rasters of directions keep the bytes that they had as signed numbers: -1 where water leaves, -2 without data.
TEST(Direction, KeepsItsBytes) {
    EXPECT_EQ(static_cast<std::int8_t>(Direction::leaves), -1);
    EXPECT_EQ(static_cast<std::int8_t>(Direction::no_data), -2);
    EXPECT_EQ(static_cast<int>(Direction::east), 0);
    EXPECT_EQ(static_cast<int>(Direction::north_east), 7);
}

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

} // namespace direction_test
