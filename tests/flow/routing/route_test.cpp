// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/route.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <measure/dems.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

#include "filled_slowly.hpp"

namespace route_test {

using namespace thalweg;
using flow::Direction;
using flow::FlowField;
using flow::route;

namespace {

using test::on_threads;

std::vector<Direction> directions(FlowField const& d) {
    return {d.direction.values().begin(), d.direction.values().end()};
}

std::vector<std::int64_t> areas(FlowField const& d) {
    return {d.area_cells.values().begin(), d.area_cells.values().end()};
}

Cell next_of(Cell c, Direction direction) {
    Cell const step = d8_steps[index_of(direction)];
    return {c.col + step.col, c.row + step.row};
}

} // namespace

TEST(Route, RefusesNoCellsAndInfiniteHeights) {
    EXPECT_THROW(route(Raster<float>{}), BadInput);
    EXPECT_THROW(route(dem_of(2, {1, -std::numeric_limits<float>::infinity()})), BadInput);
}

TEST(Route, OneCellLeaves) {
    FlowField const d = route(dem_of(1, {3}));
    EXPECT_EQ(directions(d), std::vector<Direction>{Direction::leaves});
    EXPECT_EQ(areas(d), std::vector<std::int64_t>{1});
    EXPECT_EQ(d.pits, 0);
}

TEST(Route, NoDataOnly) {
    FlowField const d = route(Raster<float>(frame(3, 2), hole));
    EXPECT_EQ(directions(d), std::vector<Direction>(6, Direction::no_data));
    EXPECT_EQ(areas(d), std::vector<std::int64_t>(6, 0));
}

TEST(Route, RowFallsToItsLowestCell) {
    FlowField const d = route(dem_of(5, {4, 2, 0, 1, 7}));
    EXPECT_EQ(directions(d), (std::vector<Direction>{Direction::east, Direction::east, Direction::leaves,
                                                     Direction::west, Direction::west}));
    EXPECT_EQ(areas(d), (std::vector<std::int64_t>{1, 2, 5, 2, 1}));
}

TEST(Route, DiagonalsAreLonger) {
    // From the centre: 1.0 to the east, 1.3 to the south-east, which is 0.92 a cell.
    Raster<float> dem(frame(3, 3), 9.0F);
    dem[4] = 5.0F;
    dem[5] = 4.0F;
    dem[8] = 3.7F;
    EXPECT_EQ(route(dem).direction[4], Direction::east);
    dem[8] = 3.5F;
    EXPECT_EQ(route(dem).direction[4], Direction::south_east);
}

TEST(Route, TiesGoToTheLowestDirection) {
    Raster<float> dem(frame(3, 3), 9.0F);
    dem[4] = 5.0F;
    dem[1] = dem[3] = dem[7] = 4.0F; // N, W, S
    EXPECT_EQ(route(dem).direction[4], Direction::south);
}

TEST(Route, PitIsFilledToWhereItSpills) {
    Raster<float> dem(frame(5, 5), 10.0F);
    dem[{2, 2}] = 1.0F;
    dem[{1, 2}] = 2.0F;
    dem[{4, 1}] = 7.0F; // beside {3, 1}, which is 8
    dem[{3, 1}] = 8.0F;
    FlowField const d = route(dem);
    EXPECT_EQ(d.pits, 2);
    EXPECT_EQ(d.pit_volume_m3, 7.0 + 6.0);
    EXPECT_EQ(d.direction[(Cell{1, 2})], Direction::east);
    EXPECT_EQ(d.direction[(Cell{2, 2})], Direction::north_east);
    EXPECT_EQ(d.direction[(Cell{3, 1})], Direction::east);
    EXPECT_EQ(d.direction[(Cell{4, 1})], Direction::leaves);
    EXPECT_GE(d.area_cells[(Cell{2, 2})], 2);
    Grid grid = dem.grid();
    grid.cell_m = 10.0;
    Raster<float> wide(grid);
    std::copy(dem.values().begin(), dem.values().end(), wide.values().begin());
    EXPECT_EQ(route(wide).pit_volume_m3, 1300.0);
}

TEST(Route, NoDataTakesWater) {
    // A bowl with a hole in its middle: nothing is filled, all water goes into the hole.
    Raster<float> dem = dem_of(5, {9, 9, 9,    9, 9, //
                                   9, 5, 5,    5, 9, //
                                   9, 5, hole, 5, 9, //
                                   9, 5, 5,    5, 9, //
                                   9, 9, 9,    9, 9});
    FlowField const d = route(dem);
    EXPECT_EQ(d.pits, 0);
    for (Cell const c : {Cell{1, 1}, Cell{2, 1}, Cell{3, 3}}) {
        EXPECT_EQ(d.direction[c], Direction::leaves);
    }
    EXPECT_EQ(d.direction[(Cell{2, 2})], Direction::no_data);
    EXPECT_EQ(d.area_cells[(Cell{2, 2})], 0);
    EXPECT_EQ(d.direction[(Cell{0, 0})], Direction::south_east);
}

TEST(Route, BothZerosAreLevel) {
    Raster<float> dem(frame(7, 7), 0.0F);
    for (std::int64_t i = 0; i < dem.cells(); i += 2) {
        dem[i] = -0.0F;
    }
    EXPECT_EQ(directions(route(dem)), directions(route(Raster<float>(frame(7, 7), 0.0F))));
}

TEST(Route, LawsOnAnyDem) {
    ASSERT_TRUE(rc::check("every cell drains out, as counted by walking", [] {
        Raster<float> const dem = *gen_dem(9, 30);
        Grid const& grid = dem.grid();
        FlowField const d = route(dem);
        auto const level = filled_slowly(dem);

        Raster<std::int64_t> walked(grid);
        std::int64_t with_data = 0;
        std::int64_t leaving = 0;
        std::int64_t raised = 0;
        double volume = 0.0;
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            RC_ASSERT((d.direction[i] == Direction::no_data) == static_cast<bool>(std::isnan(dem[i])));
            if (std::isnan(dem[i])) {
                continue;
            }
            ++with_data;
            double const here = level[static_cast<std::size_t>(i)];
            raised += here > dem[i] ? 1 : 0;
            volume += here - dem[i];

            // Steepest descent on the filled DEM; level only where nothing is lower, and out only from the rim.
            double steepest = 0.0;
            int best = -1;
            bool rim = false;
            for (std::size_t k = 0; k < 8; ++k) {
                Cell const n = next_of(grid.at(i), flow::direction_of(k));
                if (!grid.contains(n) || std::isnan(dem[n])) {
                    rim = true;
                    continue;
                }
                double const drop = here - level[static_cast<std::size_t>(grid.index(n))];
                double const slope = k % 2 == 0 ? drop : drop / std::sqrt(2.0);
                if (slope > steepest) {
                    steepest = slope;
                    best = static_cast<int>(k);
                }
            }
            if (best >= 0) {
                RC_ASSERT(static_cast<int>(d.direction[i]) == best);
            } else if (d.direction[i] == Direction::leaves) {
                RC_ASSERT(rim);
            } else {
                Cell const n = next_of(grid.at(i), d.direction[i]);
                RC_ASSERT((grid.contains(n) && level[static_cast<std::size_t>(grid.index(n))] == here));
            }

            std::int64_t steps = 0;
            Cell c = grid.at(i);
            for (;; c = next_of(c, d.direction[c])) {
                ++walked[c];
                RC_ASSERT(++steps <= grid.cells());
                if (!goes_on(d.direction[c])) {
                    break;
                }
            }
            RC_ASSERT(d.direction[c] == Direction::leaves);
        }
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            RC_ASSERT(walked[i] == d.area_cells[i]);
            leaving += d.direction[i] == Direction::leaves ? d.area_cells[i] : 0;
        }
        RC_ASSERT(leaving == with_data);
        RC_ASSERT(d.pits == raised);
        RC_ASSERT(d.pit_volume_m3 == volume); // whole heights
    }));
}

TEST(Route, WithoutDepressionsNothingIsFilled) {
    ASSERT_TRUE(rc::check("a DEM that falls to the east has no pits", [] {
        Raster<float> dem = *gen_dem(9, 0);
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            dem[i] -= 3000.0F * static_cast<float>(dem.grid().at(i).col);
        }
        FlowField const d = route(dem);
        RC_ASSERT(d.pits == 0);
        RC_ASSERT(d.pit_volume_m3 == 0.0);
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            if (dem.grid().at(i).col + 1 < dem.width()) {
                RC_ASSERT(goes_on(d.direction[i]));
                RC_ASSERT(dem[next_of(dem.grid().at(i), d.direction[i])] < dem[i]);
            }
        }
    }));
}

TEST(Route, SameForAnyNumberOfThreads) {
    Raster<float> dem = rough_dem(frame(900, 700), 3);
    thalweg::Run const one = on_threads(1);
    thalweg::Run const three = on_threads(3);
    FlowField const a = route(dem, one);
    FlowField const b = route(dem, three);
    EXPECT_EQ(directions(a), directions(b));
    EXPECT_EQ(areas(a), areas(b));
    EXPECT_EQ(a.pit_volume_m3, b.pit_volume_m3);
    EXPECT_GT(a.pits, 100'000);
}

TEST(Route, StopsWhenAsked) {
    thalweg::Run run;
    run.progress = [](double, char const*, void*) { return 0; };
    EXPECT_THROW(route(rough_dem(frame(1000, 1000), 3), run), Cancelled);
}

} // namespace route_test
