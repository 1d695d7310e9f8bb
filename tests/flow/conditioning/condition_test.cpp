// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/conditioning/condition.hpp>

#include <thalweg/core/cells/d8.hpp>
#include <thalweg/core/numbers/chance.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/conditioning/internal/carve.hpp>
#include <thalweg/flow/conditioning/internal/fill.hpp>
#include <thalweg/flow/conditioning/internal/raise_banks.hpp>
#include <thalweg/flow/conditioning/internal/small_step.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "plain_drainage.hpp"

using namespace thalweg;
using flow::Banks;
using flow::carve;
using flow::condition;
using flow::ConditionedDem;
using flow::Conditioning;
using flow::fill;
using flow::raise_banks;

namespace {

using plain::no_data;

Grid frame(std::int64_t width, std::int64_t height) {
    return {width, height, 1.0, 0.0, static_cast<double>(height), ""};
}

Valley no_rivers(Grid const& grid) {
    return {Raster<float>(grid, no_data)};
}

std::vector<Cell> beside(Grid const& grid, Cell at) {
    std::vector<Cell> out;
    for (Cell const step : d8_steps) {
        if (Cell const n{at.col + step.col, at.row + step.row}; grid.contains(n)) {
            out.push_back(n);
        }
    }
    return out;
}

/// A land of any roughness, with holes, and rivers in it that fall to its border or run level.
struct Scene {
    Raster<float> dem;
    Valley valley;
};

Scene any_scene() {
    auto const width = *rc::gen::inRange<std::int64_t>(1, 15).as("width");
    auto const height = *rc::gen::inRange<std::int64_t>(1, 15).as("height");
    auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30).as("seed");
    auto const rivers = *rc::gen::inRange(0, 4).as("rivers");
    bool const stepped = *rc::gen::arbitrary<bool>().as("stepped");
    double const holes = *rc::gen::element(0.0, 0.0, 0.1).as("holes");
    Scene scene{Raster<float>(frame(width, height)), no_rivers(frame(width, height))};
    Grid const& grid = scene.dem.grid();
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        double const u = 40.0 * unit(chance(seed, 1, static_cast<std::uint64_t>(i)));
        bool const hole = unit(chance(seed, 2, static_cast<std::uint64_t>(i))) < holes;
        scene.dem[i] = hole ? no_data : static_cast<float>(stepped ? std::floor(u / 8.0) : u);
    }
    std::uint64_t draw = 0;
    auto const pick = [&](std::int64_t n) {
        return static_cast<std::int64_t>(chance(seed, 3, ++draw) % static_cast<std::uint64_t>(n));
    };
    // All on one clock, so that where rivers meet the later, lower one goes on.
    double z = 30.0;
    for (int r = 0; r < rivers; ++r) {
        Cell at{pick(width), pick(height)};
        for (bool on = true; on; at = {at.col + pick(3) - 1, at.row + pick(3) - 1}) {
            on = grid.contains(at);
            if (on) {
                z -= 0.05 * static_cast<double>(pick(3));
                scene.valley.z[at] = scene.dem[at] = static_cast<float>(z);
            }
        }
    }
    return scene;
}

bool leaves(Raster<float> const& dem, Cell at) {
    auto const around = beside(dem.grid(), at);
    return around.size() < 8 || std::any_of(around.begin(), around.end(), [&](Cell n) { return std::isnan(dem[n]); });
}

void require_drained(Raster<float> const& dem, Valley const& valley) {
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Cell const at = dem.grid().at(i);
        if (std::isnan(dem[i]) || !std::isnan(valley.z[i]) || leaves(dem, at)) {
            continue;
        }
        auto const around = beside(dem.grid(), at);
        RC_ASSERT(std::any_of(around.begin(), around.end(), [&](Cell n) { return dem[n] < dem[i]; }));
    }
}

void require_rivers_untouched(Raster<float> const& dem, Scene const& scene) {
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (!std::isnan(scene.valley.z[i])) {
            RC_ASSERT(std::bit_cast<std::uint32_t>(dem[i]) == std::bit_cast<std::uint32_t>(scene.dem[i]));
        }
        RC_ASSERT(std::isnan(dem[i]) == std::isnan(scene.dem[i]));
    }
}

/// The law of raise_banks.
void require_water_kept(Raster<float> const& dem, Valley const& valley) {
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (std::isnan(valley.z[i])) {
            continue;
        }
        Cell const at = dem.grid().at(i);
        double steepest_river = 0.0;
        double lowest_river = std::numeric_limits<double>::infinity();
        double steepest_land = 0.0;
        double lowest_land = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < 8; ++k) {
            Cell const n{at.col + d8_steps[k].col, at.row + d8_steps[k].row};
            if (!dem.grid().contains(n) || std::isnan(dem[n])) {
                continue;
            }
            double const length = k % 2 == 0 ? 1.0 : std::sqrt(2.0);
            double const slope = (static_cast<double>(dem[at]) - static_cast<double>(dem[n])) / length;
            bool const river = !std::isnan(valley.z[n]);
            double& steepest = river ? steepest_river : steepest_land;
            double& lowest = river ? lowest_river : lowest_land;
            steepest = std::max(steepest, slope);
            lowest = std::min(lowest, static_cast<double>(dem[n]));
        }
        if (steepest_river > 0.0) {
            RC_ASSERT(steepest_land < steepest_river);
            RC_ASSERT(lowest_river < lowest_land);
        } else {
            RC_ASSERT(lowest_land > static_cast<double>(dem[i]));
        }
    }
}

} // namespace

TEST(DrainLand, RefusesWhatIsNoLand) {
    Grid const grid = frame(3, 3);
    EXPECT_THROW(fill(Raster<float>{}, Valley{}), BadInput);
    EXPECT_THROW(fill(Raster<float>(grid), no_rivers(frame(3, 2))), BadInput);
    Raster<float> infinite(grid);
    infinite[4] = std::numeric_limits<float>::infinity();
    EXPECT_THROW(condition(infinite, no_rivers(grid)), BadInput);
    Valley river = no_rivers(grid);
    river.z[4] = 1.0F;
    EXPECT_THROW(condition(Raster<float>(grid, no_data), river), BadInput);
    EXPECT_THROW(carve(Raster<float>(grid), no_rivers(grid), Raster<float>(frame(2, 3))), BadInput);
    EXPECT_THROW(raise_banks(Raster<float>(grid), no_rivers(grid), {-1.0}), BadParameter);
}

TEST(DrainLand, NoneChangesNothing) {
    Grid const grid = frame(3, 3);
    Raster<float> bowl(grid, 5.0F);
    bowl[4] = 1.0F;
    ConditionedDem const land = condition(bowl, no_rivers(grid), {Conditioning::none});
    EXPECT_TRUE(std::equal(land.dem.values().begin(), land.dem.values().end(), bowl.values().begin()));
    EXPECT_EQ(land.depressions.volume_m3(), 0.0);
}

TEST(DrainLand, FillsOrCutsWhicheverMovesLess) {
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

TEST(DrainLand, PitBelowTheRiversAroundItIsFilled) {
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

TEST(DrainLand, FillIsTheLeastThatDrains) {
    ASSERT_TRUE(rc::check("fill equals lowering from above by the definition, bit for bit", [] {
        Scene const scene = any_scene();
        Raster<float> const filled = fill(scene.dem, scene.valley);
        Raster<float> const slowly = plain::filled(scene.dem, scene.valley);
        for (std::int64_t i = 0; i < filled.cells(); ++i) {
            RC_ASSERT((std::isnan(filled[i]) ? std::isnan(slowly[i]) : filled[i] == slowly[i]));
        }
        require_drained(filled, scene.valley);
        require_rivers_untouched(filled, scene);
    }));
}

TEST(DrainLand, BanksKeepTheRiversWater) {
    ASSERT_TRUE(rc::check("raise_banks", [] {
        Scene const scene = any_scene();
        Banks const banks = raise_banks(scene.dem, scene.valley);
        require_rivers_untouched(banks.dem, scene);
        require_water_kept(banks.dem, scene.valley);
        for (std::int64_t i = 0; i < scene.dem.cells(); ++i) {
            if (!std::isnan(scene.dem[i])) {
                RC_ASSERT((banks.dem[i] == scene.dem[i] || banks.dem[i] == banks.least[i]));
                RC_ASSERT(!(banks.dem[i] < banks.least[i]));
            }
        }
        // The least: any raised cell a little lower, and some river loses its water or its margin.
        flow::RaiseBanksParams none;
        none.margin_m = 0.0;
        Banks tight = raise_banks(scene.dem, scene.valley, none);
        for (std::int64_t i = 0; i < scene.dem.cells(); ++i) {
            if (tight.dem[i] > scene.dem[i]) {
                float const kept = tight.dem[i];
                tight.dem[i] = kept - 0.001F;
                bool drawn = false;
                for (Cell const u : beside(scene.dem.grid(), scene.dem.grid().at(i))) {
                    drawn = drawn || (!std::isnan(scene.valley.z[u]) && plain::prefers(tight.dem, scene.valley, u, i));
                }
                RC_ASSERT(drawn);
                tight.dem[i] = kept;
            }
        }
    }));
}

TEST(DrainLand, CarveDrainsAndKeepsRivers) {
    ASSERT_TRUE(rc::check("drain by carving", [] {
        Scene const scene = any_scene();
        Banks const banks = raise_banks(scene.dem, scene.valley);
        Raster<float> const carved = carve(banks.dem, scene.valley, banks.least);
        require_drained(carved, scene.valley);
        require_rivers_untouched(carved, scene);
        require_water_kept(carved, scene.valley);
        auto const by_filling = flow::change_between(banks.dem, fill(banks.dem, scene.valley));
        auto const by_carving = flow::change_between(banks.dem, carved);
        double const steps = 1e-4 * static_cast<double>(carved.cells());
        RC_ASSERT(by_carving.volume_m3() <= by_filling.volume_m3() + steps);
        for (std::int64_t i = 0; i < carved.cells(); ++i) {
            RC_ASSERT(!(carved[i] < banks.least[i]));
        }
    }));
}

TEST(DrainLand, OneBowlTakesTheCheapestWay) {
    ASSERT_TRUE(rc::check("no more than the cheapest of all simple ways out, or filling", [] {
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30).as("seed");
        auto const rings = *rc::gen::inRange<std::int64_t>(2, 4).as("rings");
        std::int64_t const side = 2 * rings + 1;
        Raster<float> bowl(frame(side, side));
        double const rim = *rc::gen::element(1.0, 3.0, 10.0).as("rim");
        for (std::int64_t i = 0; i < bowl.cells(); ++i) {
            Cell const c = bowl.grid().at(i);
            auto const ring = std::max(std::abs(c.col - rings), std::abs(c.row - rings));
            double const u = unit(chance(seed, static_cast<std::uint64_t>(i)));
            bowl[i] = static_cast<float>(ring == 0       ? 0.0
                                         : ring == rings ? static_cast<double>(ring) + rim * u
                                                         : static_cast<double>(ring) + 0.9 * u);
        }
        ConditionedDem const land = condition(bowl, no_rivers(bowl.grid()));
        double const least = std::min(plain::fill_volume(bowl), plain::cheapest_way_out(bowl, {rings, rings}));
        RC_ASSERT(land.depressions.volume_m3() <= least + 1e-3);
    }));
}

TEST(DrainLand, MovesLittleMoreThanTheBetterOfFillingAndBreaching) {
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
