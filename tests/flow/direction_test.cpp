// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/direction.hpp>

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

namespace direction_test {

using namespace thalweg;
using flow::Direction;
using flow::direction_of;

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

} // namespace direction_test
