// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/growth/forest/coast.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <network/masks.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

namespace coast_test {

using namespace thalweg;
using namespace thalweg::growth;
using test::components;
using test::frame;
using test::mask_of;
using test::random_blob;

namespace {

using test::on_threads;

std::int64_t land_cells(Mask const& land) {
    return std::ranges::count(land.values(), std::uint8_t{1});
}

} // namespace

TEST(SpreadOutlets, coast_touches_sea_or_border) {
    EXPECT_TRUE(coast_cells(mask_of({"..", ".."})).empty());
    EXPECT_EQ(coast_cells(mask_of({"#"})), (std::vector<Cell>{{0, 0}}));
    EXPECT_EQ(coast_cells(Mask(frame(5, 4), 1)).size(), 14U);
    // A cell that meets the sea by a corner only is inland.
    EXPECT_EQ(coast_cells(mask_of({".......", ".#####.", ".#####.", ".####..", ".......", "......."})).size(), 11U);
}

TEST(SpreadOutlets, refuses_what_it_cannot_do) {
    Mask const land(frame(9, 9), 1);
    EXPECT_THROW(spread_outlets(land, {}), BadInput);
    for (SpreadOutletsParams const& wrong : {SpreadOutletsParams{-1, 60.0, 7}, {0, 0.0, 7}, {0, std::nan(""), 7}}) {
        EXPECT_THROW(spread_outlets(land, coast_cells(land), wrong), BadParameter);
    }
}

// Laws: outlets are cells of the coast, three cells apart; as many as asked, or no other would be.
TEST(SpreadOutlets, laws) {
    ASSERT_TRUE(rc::check([] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        Mask const land =
            random_blob(seed, *rc::gen::inRange(1, 90), *rc::gen::inRange(1, 90), 5, *rc::gen::inRange(1, 20));
        std::vector<Cell> const coast = coast_cells(land);
        auto const wanted = *rc::gen::inRange<std::int64_t>(1, 60);
        std::vector<Cell> const outlets = spread_outlets(land, coast, {wanted, 60.0, seed});
        auto const near = [](Cell a, Cell b) {
            return (a.col - b.col) * (a.col - b.col) + (a.row - b.row) * (a.row - b.row) < 9;
        };
        RC_ASSERT(static_cast<std::int64_t>(outlets.size()) <= wanted);
        for (std::size_t i = 0; i < outlets.size(); ++i) {
            RC_ASSERT(std::ranges::find(coast, outlets[i]) != coast.end());
            for (std::size_t k = 0; k < i; ++k) {
                RC_ASSERT(!near(outlets[i], outlets[k]));
            }
        }
        if (static_cast<std::int64_t>(outlets.size()) < wanted) {
            for (Cell const c : coast) {
                RC_ASSERT(std::ranges::any_of(outlets, [&](Cell o) { return near(c, o); }));
            }
        }
    }));
}

// Distances are neither all alike nor independent: their deviation is a third to two thirds of their mean.
TEST(SpreadOutlets, distances_are_natural) {
    Mask const land(frame(3000, 1), 1);
    std::vector<Cell> outlets = spread_outlets(land, coast_cells(land), {60, 60.0, 7});
    ASSERT_EQ(outlets.size(), 60U);
    std::ranges::sort(outlets, {}, &Cell::col);
    double sum = 0.0;
    double squares = 0.0;
    for (std::size_t i = 1; i < outlets.size(); ++i) {
        auto const gap = static_cast<double>(outlets[i].col - outlets[i - 1].col);
        sum += gap;
        squares += gap * gap;
    }
    double const mean = sum / 59.0;
    double const deviation = std::sqrt(squares / 59.0 - mean * mean);
    EXPECT_GT(deviation / mean, 0.2);
    EXPECT_LT(deviation / mean, 0.7);
}

// There are more mouths in bays than on capes: a bay and a cape of the same shape.
TEST(SpreadOutlets, bays_have_more_than_capes) {
    Mask land(frame(200, 120), 0);
    auto const wedge = [](Cell c, std::int64_t tip) { return 40 - std::abs(c.col - tip); };
    for (std::int64_t i = 0; i < land.cells(); ++i) {
        Cell const c = land.grid().at(i);
        std::int64_t const shore =
            60 + std::max<std::int64_t>(wedge(c, 50), 0) - std::max<std::int64_t>(wedge(c, 150), 0);
        land[i] = c.row < shore ? 1 : 0;
    }
    std::vector<Cell> coast = coast_cells(land);
    std::erase_if(coast, [&](Cell c) { return land.grid().on_border(c); });
    int cape = 0;
    int bay = 0;
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        Cell const c = spread_outlets(land, coast, {1, 60.0, seed}).front();
        cape += c.col > 44 && c.col < 57;
        bay += c.col > 144 && c.col < 157;
    }
    EXPECT_GT(bay, 2 * cape);
    EXPECT_GT(cape, 0);
}

TEST(ShapeIsland, refuses_what_leaves_no_island) {
    EXPECT_THROW(shape_island(frame(15, 90)), BadInput);
    for (double const r : {-0.1, 1.1, std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_THROW(shape_island(frame(30, 30), {r, 7}), BadParameter) << r;
    }
}

// Laws: about two fifths of the grid are land; a margin of sea; no lagoon; no islet of less than a thousandth.
TEST(ShapeIsland, laws) {
    ASSERT_TRUE(rc::check([] {
        Grid const grid = frame(*rc::gen::inRange(16, 150), *rc::gen::inRange(16, 150));
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        Mask const land = shape_island(grid, {*rc::gen::element(0.0, 0.3, 0.6, 1.0), seed});
        RC_ASSERT(land_cells(land) * 10 > 3 * grid.cells());
        RC_ASSERT(land_cells(land) * 10 < 6 * grid.cells());
        RC_ASSERT(components(land, 0, 4) == 1);
        auto const margin = std::min(grid.width, grid.height) / 40;
        for (std::int64_t i = 0; i < land.cells(); ++i) {
            Cell const c = grid.at(i);
            auto const to_edge = std::min({c.col, c.row, grid.width - 1 - c.col, grid.height - 1 - c.row});
            RC_ASSERT((land[i] == 0 || to_edge >= std::max<std::int64_t>(margin, 1)));
        }
        RC_ASSERT(components(land, 1, 4) * (grid.cells() / 1000) <= land_cells(land));
    }));
}

// The square of the coast's length over the area does not depend on the size of the island.
TEST(ShapeIsland, ruggedness_makes_the_coast_longer) {
    Grid const grid = frame(400, 400);
    double before = 0.0;
    for (double const r : {0.0, 0.5, 1.0}) {
        double length = 0.0;
        for (std::uint64_t seed = 0; seed < 4; ++seed) {
            Mask const land = shape_island(grid, {r, seed});
            auto const coast = static_cast<double>(coast_cells(land).size());
            length += coast * coast / static_cast<double>(land_cells(land));
        }
        EXPECT_GT(length, 1.2 * before) << r;
        before = length;
    }
}

// Law: no field of Run changes a result; the seed does.
TEST(ShapeIsland, same_mask_for_any_number_of_threads) {
    Grid const grid = frame(130, 90);
    Mask const one = shape_island(grid, {0.5, 7}, on_threads(1));
    EXPECT_TRUE(test::same_bits(one, shape_island(grid, {0.5, 7}, on_threads(3))));
    EXPECT_FALSE(test::same_bits(one, shape_island(grid, {0.5, 8})));
}

} // namespace coast_test
