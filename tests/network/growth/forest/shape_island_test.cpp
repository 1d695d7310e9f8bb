// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/forest/coast.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <network/masks.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

namespace shape_island_test {

using namespace thalweg;
using namespace thalweg::network;
using test::components;
using test::frame;

namespace {

using test::on_threads;

std::int64_t land_cells(Mask const& land) {
    return std::ranges::count(land.values(), std::uint8_t{1});
}

} // namespace

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

// The square of the coast's length over the area, which does not know how large an island is.
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
    thalweg::Run const one = on_threads(1);
    thalweg::Run const three = on_threads(3);
    auto const cells = [](Mask const& m) { return std::vector<std::uint8_t>(m.values().begin(), m.values().end()); };
    EXPECT_EQ(cells(shape_island(grid, {0.5, 7}, one)), cells(shape_island(grid, {0.5, 7}, three)));
    EXPECT_NE(cells(shape_island(grid, {0.5, 7})), cells(shape_island(grid, {0.5, 8})));
}

} // namespace shape_island_test
