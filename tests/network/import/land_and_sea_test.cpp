// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/land_and_sea.hpp>

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>
#include <network/networks.hpp>
#include <network/rivers.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/network/planform/carry_outlets.hpp>

namespace land_and_sea_test {

namespace {

using namespace thalweg;
using network::land_and_sea;
using network::LandAndSea;
using test::flats;

bool touches_sea(Mask const& land, Cell c) {
    bool found = land.grid().on_border(c);
    cells_around(land.grid(), c, 1, [&](Cell n) { found = found || land[n] == 0; });
    return found;
}

/// A coast that crosses the grid from west to east, as a function of x, and rivers that come down to it from the north.
struct Shore {
    std::vector<Vec2> coast;
    std::vector<std::vector<Vec2>> rivers;
};

Shore shore(std::uint64_t seed) {
    Shore made;
    for (int x = -4; x <= 68; x += 4) {
        made.coast.push_back({static_cast<double>(x), 20.0 + 10.0 * unit(random_word(seed, 1, x + 100))});
    }
    for (std::size_t k = 3; k + 3 < made.coast.size(); k += 3) {
        Vec2 const mouth = made.coast[k];
        made.rivers.push_back({{mouth.x + 3.0, 60.0}, {mouth.x + 1.0, 45.0}, mouth});
    }
    return made;
}

} // namespace

TEST(LandAndSea, WithoutACoastInTheGridAllIsLand) {
    Grid const grid = test::frame(20, 20);
    EXPECT_EQ(land_and_sea({}, flats({{{2, 2}, {9, 9}}}), grid).land.cells(), 0);
    EXPECT_EQ(land_and_sea(flats({{{-40, 5}, {-30, 9}}}), flats({{{2, 2}, {9, 9}}}), grid).land.cells(), 0);
}

TEST(LandAndSea, WaterLiesToTheRightUnlessRiversDo) {
    Grid const grid = test::frame(20, 20);
    std::vector<Vec2> const north{{10, -5}, {10, 25}};
    // Northward: the east is the right.
    LandAndSea const none = land_and_sea(flats({north}), {}, grid);
    EXPECT_EQ((none.land[Cell{2, 10}]), 1);
    EXPECT_EQ((none.land[Cell{17, 10}]), 0);
    EXPECT_EQ(none.sea_cells, 200);
    LandAndSea const east = land_and_sea(flats({north}), flats({{{18, 10}, {10, 10}}}), grid);
    EXPECT_EQ((east.land[Cell{2, 10}]), 0);
    EXPECT_EQ((east.land[Cell{17, 10}]), 1);
    EXPECT_GT(east.behind, 0);
}

TEST(LandAndSea, IsLikeTheNearestCoastlineWhereOneCrossesTheGrid) {
    ASSERT_TRUE(rc::check("below the coast is sea, above it land", [] {
        Shore const made = shore(*rc::gen::arbitrary<std::uint64_t>());
        Grid const grid = test::frame(64, 64);
        std::vector<Vec2> drawn = made.coast;
        if (*rc::gen::arbitrary<bool>()) { // the rivers say which side is land
            std::reverse(drawn.begin(), drawn.end());
        }
        LandAndSea const divided = land_and_sea(flats({drawn}), flats(made.rivers), grid);
        RC_ASSERT(divided.land.cells() == grid.cells());
        std::int64_t sea = 0;
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            Vec2 const p = grid.centre(grid.at(i));
            auto const right = std::find_if(made.coast.begin(), made.coast.end(), [&](Vec2 q) { return q.x > p.x; });
            Vec2 const a = *(right - 1);
            double const coast = a.y + (right->y - a.y) * (p.x - a.x) / (right->x - a.x);
            RC_ASSERT(divided.land[i] == (p.y >= coast ? 1 : 0));
            sea += divided.land[i] == 0 ? 1 : 0;
        }
        RC_ASSERT(divided.sea_cells == sea);
    }));
}

TEST(LandAndSea, BeyondTheEndsOfACoastlineItGoesMidwayToTheRivers) {
    Grid const grid = test::frame(64, 64);
    // The coast ends at x = 30; a river runs east of it, far to the north.
    LandAndSea const divided = land_and_sea(flats({{{-1, 20}, {30, 20}}}), flats({{{60, 60}, {60, 40}}}), grid);
    EXPECT_EQ((divided.land[grid.cell_of({10, 10})]), 0);
    EXPECT_EQ((divided.land[grid.cell_of({10, 40})]), 1);
    EXPECT_EQ((divided.land[grid.cell_of({60, 30})]), 1);
    EXPECT_EQ((divided.land[grid.cell_of({40, 12})]), 0);
}

TEST(LandAndSea, ARiverDrawnBeyondTheCoastMakesNoLandThere) {
    Grid const grid = test::frame(64, 64);
    std::vector<Vec2> const coast{{-1, 30}, {65, 30}};
    LandAndSea const divided = land_and_sea(flats({coast}), flats({{{20, 60}, {20, 30}, {24, 8}}}), grid);
    EXPECT_EQ(divided.sea_cells, 64 * 30);
    EXPECT_GT(divided.behind, 0);
    EXPECT_GT(divided.beyond, 0);
}

TEST(LandAndSea, RiversKeepLandAroundThem) {
    Grid const grid = test::frame(24, 24);
    StreamNetwork const net = test::network_of({{12.5, 4.5}, {12.5, 20.5}}, {{1, 0}});
    Mask const land = network::land_along_rivers(Mask(grid, 0), net);
    EXPECT_EQ(std::count(land.values().begin(), land.values().end(), 1),
              3 * 18); // the outlet's row by the cell above it
    EXPECT_TRUE(touches_sea(land, grid.cell_of({12.5, 4.5})));
    EXPECT_FALSE(touches_sea(land, grid.cell_of({12.5, 6.5})));
}

TEST(LandBehindOutlets, EachOutletInsideLiesAtTheSea) {
    ASSERT_TRUE(rc::check("rivers are land; before every outlet there is sea; sources have none behind them", [] {
        Shore const made = shore(*rc::gen::arbitrary<std::uint64_t>());
        Grid const grid = test::frame(64, 64);
        std::vector<Vec2> nodes;
        std::vector<test::Reach> reaches;
        for (std::vector<Vec2> const& river : made.rivers) {
            nodes.push_back(river[2]);
            nodes.push_back(river[0]);
            reaches.push_back({nodes.size() - 1, nodes.size() - 2, {river[1]}});
        }
        StreamNetwork const net = test::network_of(nodes, reaches);
        Mask const land = network::land_behind_outlets(net, grid);
        RC_ASSERT(land.cells() == grid.cells());
        for (std::vector<Vec2> const& river : made.rivers) {
            for (Cell const c : cells_along(river, grid)) {
                RC_ASSERT(land[c] == 1);
            }
            RC_ASSERT(touches_sea(land, grid.cell_of(river[2])));
            RC_ASSERT(land[grid.cell_of({river[0].x, 63.5})] == 1);
            RC_ASSERT(land[grid.cell_of({river[2].x - 1.0, 2.5})] == 0);
        }
    }));
}

TEST(LandBehindOutlets, WhereAllOutletsLieOnTheBorderAllIsLand) {
    Grid const grid = test::frame(16, 16);
    EXPECT_EQ(network::land_behind_outlets(test::network_of({{8.5, 0.5}, {8.5, 9.5}}, {{1, 0}}), grid).cells(), 0);
}

TEST(CarryOutlets, EndsAtTheSea) {
    Grid const grid = test::frame(32, 32);
    Mask land(grid, 1);
    for (std::int64_t row = 0; row < 32; ++row) {
        for (std::int64_t col = 0; col < 10; ++col) {
            land[Cell{col, row}] = 0;
        }
    }
    StreamNetwork const net = test::network_of({{16.5, 16.5}, {26.5, 16.5}}, {{1, 0}});
    auto const carried = network::carry_outlets(net, land, 100);
    ASSERT_EQ(carried.notes.size(), 1U);
    EXPECT_EQ(carried.network.node(0).at.x, 10.5);
    std::vector<Cell> const way = cells_along(carried.network.arc(0).line, grid);
    for (std::size_t i = 0; i + 1 < way.size(); ++i) {
        EXPECT_FALSE(touches_sea(land, way[i]));
    }
    EXPECT_TRUE(network::carry_outlets(net, land, 5).notes.empty());
    EXPECT_TRUE(network::carry_outlets(carried.network, land, 100).notes.empty());
}

/// Ten rivers of one cell each, the last ones high above the sea.
Channels ends_beside(Grid const& grid, std::int64_t col, int high) {
    Channels channels;
    for (int i = 0; i < 10; ++i) {
        channels.cell.push_back(grid.index({col, i}));
        channels.receiver.push_back(-1);
        channels.z.push_back(i < 10 - high ? 9.0F : 300.0F);
    }
    return channels;
}

TEST(GapsAreSea, WhereNineOfTenRiversEndLowBesideThem) {
    Grid const grid = test::frame(10, 10);
    Mask land(grid, 1);
    for (std::int64_t row = 0; row < 10; ++row) {
        land[Cell{0, row}] = 0;
    }
    EXPECT_TRUE(network::gaps_are_sea(land, ends_beside(grid, 2, 1)));
    EXPECT_FALSE(network::gaps_are_sea(land, ends_beside(grid, 2, 2))) << "two of ten are high";
    EXPECT_FALSE(network::gaps_are_sea(land, ends_beside(grid, 3, 0))) << "none ends beside a gap";
    EXPECT_FALSE(network::gaps_are_sea(land, {}));
}

} // namespace land_and_sea_test
