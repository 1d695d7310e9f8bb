// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/land.hpp>
#include <thalweg/surface/equilibrium/internal/region.hpp>
#include <thalweg/surface/equilibrium/internal/start_level.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>

namespace region_test {

using namespace thalweg;
using namespace thalweg::surface;

namespace {

Grid square(std::int64_t side) {
    return {side, side, 30.0, 0.0, 30.0 * static_cast<double>(side), "EPSG:32631"};
}

/// Rivers up the middle lines from sides of the grid to near its middle, one by each step.
Channels from_sides(Grid const& grid, std::vector<Cell> const& steps) {
    Channels rivers{grid, {}, {}, {}, {}};
    std::int64_t const half = grid.width / 2;
    auto const along = [&](std::int64_t step, std::int64_t k) { return step < 0 ? half - 1 - k : half + step * k; };
    for (Cell const step : steps) {
        for (std::int64_t k = half - 1; k > 3; --k) {
            rivers.cell.push_back(grid.index({along(step.col, k), along(step.row, k)}));
            rivers.receiver.push_back(k == half - 1 ? -1 : static_cast<ChannelId>(rivers.cell.size()) - 2);
        }
    }
    return rivers;
}

/// Takes the lowest cell of a single river away.
void shorten(Channels& rivers) {
    Channels rest{rivers.grid, {}, {}, {}, {}};
    for (std::size_t n = 1; n < rivers.cell.size(); ++n) {
        rest.cell.push_back(rivers.cell[n]);
        rest.receiver.push_back(rivers.receiver[n] - 1);
    }
    rivers = rest;
}

bool same(Raster<float> const& a, Raster<float> const& b) {
    return std::equal(a.values().begin(), a.values().end(), b.values().begin(), b.values().end(),
                      [](float x, float y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

EquilibriumParams seeded(std::uint64_t seed, double region) {
    EquilibriumParams params;
    params.seed = seed;
    params.region = region;
    return params;
}

/// Whether a region changes nothing.
void expect_none(Channels const& rivers, EquilibriumFields const& fields, EquilibriumParams params) {
    params.region = 3.0;
    EquilibriumTerrain const wide = equilibrium(rivers, fields, params);
    params.region = 1.0;
    EXPECT_FALSE(wide.in_region);
    EXPECT_TRUE(wide.inflows.empty());
    EXPECT_TRUE(same(wide.dem, equilibrium(rivers, fields, params).dem));
}

/// How many cells drain to a single river, by a terrain's directions.
std::int64_t drained(EquilibriumTerrain const& land, Channels const& rivers) {
    std::set<std::int64_t> const river(rivers.cell.begin(), rivers.cell.end());
    std::int64_t count = 0;
    for (std::int64_t i = 0; i < land.direction.cells(); ++i) {
        std::int64_t at = i;
        while (at >= 0 && !river.contains(at)) {
            at = flow::receiver(land.direction, at);
        }
        count += at >= 0 ? 1 : 0;
    }
    return count;
}

} // namespace

// Beyond the edge lie valleys that fall away from the head of a river, not one as high as it.
TEST(Region, LandFarFromRiversDrainsOffTheMap) {
    Channels const rivers = from_sides(square(256), {{0, 1}});
    for (std::uint64_t seed = 1; seed < 4; ++seed) {
        EquilibriumParams params = seeded(seed, 3.0);
        params.inflow = false;
        std::int64_t const own = drained(equilibrium(rivers, {}, params), rivers);
        std::int64_t const before = drained(equilibrium(rivers, {}, seeded(seed, 1.0)), rivers);
        EXPECT_GT(own, 124 * 10);
        EXPECT_LT(own, before);
    }
}

TEST(Region, StreamsEnterTheGridAndDividesAreElsewhere) {
    Channels const rivers = from_sides(square(256), {{0, 1}});
    std::size_t entering = 0;
    for (std::uint64_t seed = 1; seed < 5; ++seed) {
        EquilibriumTerrain const land = equilibrium(rivers, {}, seeded(seed, 3.0));
        EXPECT_TRUE(land.in_region);
        for (RegionInflow const& in : land.inflows) {
            EXPECT_TRUE(rivers.grid.on_border(rivers.grid.at(in.cell)));
            EXPECT_GE(in.area_cells, 1000);
            EXPECT_LE(in.area_cells, 9 * 256 * 256 + 1000);
        }
        entering += land.inflows.size();
        EquilibriumTerrain const alone = equilibrium(rivers, {}, seeded(seed, 1.0));
        EXPECT_FALSE(alone.in_region);
        EXPECT_TRUE(alone.inflows.empty());
        EXPECT_FALSE(same(land.dem, alone.dem));
    }
    EXPECT_GE(entering, 4U);
}

TEST(Region, RiversThatLeaveApartEndAtHeightsOfTheirOwn) {
    Channels const rivers = from_sides(square(128), {{0, 1}, {1, 0}, {-1, 0}});
    EquilibriumTerrain const land = equilibrium(rivers, {}, seeded(3, 3.0));
    std::set<float> heights;
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        if (rivers.receiver[n] < 0) {
            heights.insert(land.dem[rivers.cell[n]]);
        }
    }
    EXPECT_EQ(heights.size(), 3U);
    EXPECT_EQ(*heights.begin(), 0.0F);
}

TEST(Region, IsNoneWithoutLandBeyondTheGrid) {
    Channels const rivers = from_sides(square(128), {{0, 1}});
    EquilibriumParams closed;
    closed.edge = Edge::closed;
    expect_none(rivers, {}, closed);

    EquilibriumFields coast;
    coast.land = Mask(rivers.grid, 1);
    for (std::int64_t col = 0; col < rivers.grid.width; ++col) {
        coast.land[{col, rivers.grid.height - 1}] = 0;
    }
    Channels ashore = rivers;
    shorten(ashore);
    EquilibriumParams sea;
    sea.edge = Edge::coast;
    expect_none(ashore, coast, sea);
    expect_none(from_sides(square(63), {{0, 1}}), {}, {});
}

TEST(Region, IsNoneWhereARiverEndsInside) {
    Channels rivers = from_sides(square(128), {{0, 1}});
    Channels inside = rivers;
    shorten(inside);
    expect_none(inside, {}, {});
}

TEST(Region, IsNoneForGivenHeights) {
    Channels rivers = from_sides(square(128), {{0, 1}});
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        rivers.z.push_back(100.0F + static_cast<float>(n));
    }
    EquilibriumParams soft;
    soft.heights = RiverHeights::soft;
    expect_none(rivers, {}, soft);
}

TEST(RiversOfRegion, GoOnToTheBorderOrToOneAnother) {
    Grid const grid = square(128);
    Channels const rivers = from_sides(grid, {{0, 1}, {1, 0}, {0, -1}});
    Region const region = region_around(rivers, {}, {});
    ASSERT_EQ(region.level, 3U);
    EXPECT_EQ(region.margin, 128);
    LevelExtent const wide = extent_of(region, grid);
    EXPECT_EQ(wide.width, 48);
    EXPECT_EQ(wide.corner.col, -128);
    LevelExtent const window{16, 16, {0, 0}};
    RiverCells inner; // from the three sides of the window, in its frame
    for (std::uint32_t const cell : {16U * 18U + 8U, 8U * 18U + 16U, 1U * 18U + 8U}) {
        inner.cell.push_back(cell);
        inner.receiver.push_back(-1);
        inner.direction.push_back(-1);
        inner.level.push_back(0);
        inner.number.push_back(static_cast<std::int64_t>(inner.cell.size()) - 1);
    }
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        RiverCells const out = rivers_of_region(inner, window, wide, 8, seed);
        std::set<std::uint32_t> once(out.cell.begin(), out.cell.end());
        EXPECT_EQ(once.size(), out.cell.size());
        std::size_t given = 0;
        for (std::size_t n = 0; n < out.cell.size(); ++n) {
            std::int64_t const col = out.cell[n] % 50U - 1;
            std::int64_t const row = out.cell[n] / 50U - 1;
            ASSERT_TRUE(col >= 0 && col < 48 && row >= 0 && row < 48);
            given += out.number[n] >= 0 ? 1 : 0;
            if (out.receiver[n] < 0) {
                EXPECT_TRUE(col == 0 || row == 0 || col == 47 || row == 47);
                continue;
            }
            ASSERT_LT(out.receiver[n], static_cast<std::int32_t>(n));
            auto const down = out.cell[static_cast<std::size_t>(out.receiver[n])];
            EXPECT_LE(std::abs(static_cast<std::int64_t>(down % 50U) - 1 - col), 1);
            EXPECT_LE(std::abs(static_cast<std::int64_t>(down / 50U) - 1 - row), 1);
        }
        EXPECT_EQ(given, 3U);
    }
}

TEST(OrderCells, AddsInflowsDownstream) {
    TerrainLevel level;
    level.width = 6;
    level.height = 3;
    level.type.assign(18, CellType::outside);
    level.direction.assign(18, -1);
    for (std::size_t i = 7; i < 11; ++i) {
        level.type[i] = CellType::land;
        level.direction[i] = i < 10 ? std::int8_t{0} : std::int8_t{-1};
    }
    level.inflow = {{8, 100}};
    accumulate_areas(level, {});
    EXPECT_EQ(level.area[7], 1U);
    EXPECT_EQ(level.area[8], 102U);
    EXPECT_EQ(level.area[9], 103U);
    EXPECT_EQ(level.area[10], 104U);
}

} // namespace region_test
