// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/condition.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/internal/condition.hpp>

#include "conditioning/scenes.hpp"
#include "plain_drainage.hpp"

namespace condition_test {

using namespace thalweg;
using flow::condition;
using flow::ConditionedDem;
using flow::Conditioning;
using scenes::no_data;
using scenes::no_rivers;
using test::frame;

TEST(Condition, RefusesInfiniteHeightsAndRiversWithoutData) {
    Grid const grid = frame(3, 3);
    Raster<float> infinite(grid);
    infinite[4] = std::numeric_limits<float>::infinity();
    EXPECT_THROW(condition(infinite, no_rivers(grid)), BadInput);
    Valley river = no_rivers(grid);
    river.z[4] = 1.0F;
    EXPECT_THROW(condition(Raster<float>(grid, no_data), river), BadInput);
}

TEST(Condition, NoneChangesNothing) {
    Grid const grid = frame(3, 3);
    Raster<float> bowl(grid, 5.0F);
    bowl[4] = 1.0F;
    ConditionedDem const land = condition(bowl, no_rivers(grid), {Conditioning::none});
    EXPECT_TRUE(std::equal(land.dem.values().begin(), land.dem.values().end(), bowl.values().begin()));
    EXPECT_EQ(land.depressions.volume_m3(), 0.0);
}

TEST(Condition, FillsOrCutsWhicheverMovesLess) {
    Grid grid = frame(5, 5);
    grid.cell_m = 10.0;
    Raster<float> dem(grid, 9.0F);
    dem[{1, 2}] = dem[{2, 2}] = 7.0F; // 1 m to cut in one cell, or to fill in two
    dem[{4, 2}] = 3.0F;
    dem[{3, 2}] = 8.0F;
    ConditionedDem const cut = condition(dem, no_rivers(grid), {Conditioning::carve});
    EXPECT_EQ(cut.depressions.raised_cells, 0);
    EXPECT_EQ(cut.depressions.cut_cells, 2);
    EXPECT_EQ(cut.dem[(Cell{1, 2})], 7.0F);
    EXPECT_EQ(cut.dem[(Cell{2, 2})], flow::just_below(7.0F)); // a small step on the way
    EXPECT_EQ(cut.dem[(Cell{3, 2})], flow::just_below(flow::just_below(7.0F)));
    EXPECT_NEAR(cut.depressions.cut_m3, 100.0, 0.02);
    ConditionedDem const filled = condition(dem, no_rivers(grid), {Conditioning::fill});
    EXPECT_EQ(filled.depressions.cut_cells, 0);
    EXPECT_EQ(filled.dem[(Cell{2, 2})], flow::just_above(8.0F));
    dem[{1, 2}] = 9.0F; // half a metre to fill, twice that to cut
    dem[{2, 2}] = 8.0F;
    dem[{3, 2}] = dem[{4, 2}] = 8.5F;
    EXPECT_EQ(condition(dem, no_rivers(grid), {Conditioning::carve}).depressions.cut_cells, 0);
}

TEST(Condition, PitBelowTheRiversAroundItIsFilled) {
    // A river around a hole: nothing may be cut through it.
    Grid const grid = frame(7, 7);
    Raster<float> dem(grid, 20.0F);
    Valley valley = no_rivers(grid);
    std::vector<Cell> const ring = {{2, 1}, {3, 1}, {4, 1}, {5, 2}, {5, 3}, {5, 4}, {4, 5},
                                    {3, 5}, {2, 5}, {1, 4}, {1, 3}, {1, 2}, {0, 2}};
    for (std::size_t k = 0; k < ring.size(); ++k) {
        valley.z[ring[k]] = dem[ring[k]] = 15.0F - static_cast<float>(k);
    }
    dem[{3, 3}] = -5.0F;
    ConditionedDem const land = condition(dem, valley);
    EXPECT_GT(land.dem[(Cell{3, 3})], 4.0F);
    EXPECT_EQ(land.depressions.cut_cells, 0);
    for (Cell const c : ring) {
        EXPECT_EQ(land.dem[c], valley.z[c]);
    }
}

TEST(Condition, OneBowlTakesTheCheapestWay) {
    ASSERT_TRUE(rc::check("no more than the cheapest of all simple ways out, or filling", [] {
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30).as("seed");
        auto const rings = *rc::gen::inRange<std::int64_t>(2, 4).as("rings");
        std::int64_t const side = 2 * rings + 1;
        Raster<float> bowl(frame(side, side));
        double const rim = *rc::gen::element(1.0, 3.0, 10.0).as("rim");
        for (std::int64_t i = 0; i < bowl.cells(); ++i) {
            Cell const c = bowl.grid().at(i);
            auto const ring = std::max(std::abs(c.col - rings), std::abs(c.row - rings));
            double const u = unit(random_word(seed, static_cast<std::uint64_t>(i)));
            bowl[i] = static_cast<float>(ring == 0       ? 0.0
                                         : ring == rings ? static_cast<double>(ring) + rim * u
                                                         : static_cast<double>(ring) + 0.9 * u);
        }
        ConditionedDem const land = condition(bowl, no_rivers(bowl.grid()));
        double const least = std::min(plain::fill_volume(bowl), plain::cheapest_way_out(bowl, {rings, rings}));
        RC_ASSERT(land.depressions.volume_m3() <= least + 1e-3);
    }));
}

TEST(Condition, MovesLittleMoreThanTheBetterOfFillingAndBreaching) {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        for (std::int64_t const wave : {1, 3, 8}) {
            Raster<float> const land = plain::waves(frame(48, 40), wave, seed);
            double const moved = condition(land, no_rivers(land.grid())).depressions.volume_m3();
            double const filling = plain::fill_volume(land);
            double const breaching = plain::breach_volume(land);
            EXPECT_LE(moved, 1.1 * std::min(filling, breaching) + 1e-3)
                << "seed " << seed << " wave " << wave << " filling " << filling << " breaching " << breaching;
        }
    }
}

} // namespace condition_test
