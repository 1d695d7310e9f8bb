// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/condition.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/internal/condition.hpp>

#include "plain_drainage.hpp"
#include "scenes.hpp"

namespace condition_test {

using namespace thalweg;
using flow::Banks;
using flow::carve;
using flow::carve_depressions;
using flow::check_drainable;
using flow::condition;
using flow::ConditionedDem;
using flow::Conditioning;
using flow::confine_channels;
using flow::fill;
using flow::Lakes;
using scenes::any_scene;
using scenes::beside;
using scenes::no_data;
using scenes::no_rivers;
using scenes::require_drained;
using scenes::require_rivers_untouched;
using scenes::require_water_kept;
using scenes::Scene;
using test::frame;

namespace {

using test::message_of;

Raster<float> any_depth(Grid const& grid) {
    return Raster<float>(grid, plain::no_data);
}

Raster<float> carved(Raster<float> const& dem, Raster<float> const& least) {
    return carve(dem, {Raster<float>(dem.grid(), plain::no_data)}, least);
}

Raster<float> any_carve_land() {
    auto const width = *rc::gen::inRange<std::int64_t>(1, 12).as("width");
    auto const height = *rc::gen::inRange<std::int64_t>(1, 12).as("height");
    auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30).as("seed");
    auto const steps = *rc::gen::element<std::uint64_t>(4, 1000).as("steps");
    Raster<float> dem(frame(width, height));
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        auto const at = static_cast<std::uint64_t>(i);
        dem[i] =
            random_word(seed, 1, at) % 16 == 0 ? plain::no_data : static_cast<float>(random_word(seed, 2, at) % steps);
    }
    return dem;
}

/// All of it, or within the reach of its lakes.
Raster<float> flooded(Raster<float> const& dem, Raster<float> const& rivers, Lakes lakes) {
    return flow::flooded(dem, rivers, lakes, {}, *rc::gen::element<std::int64_t>(0, 1 << 20).as("cells per lake"));
}

/// The level by definition: of all ways out, the one whose highest cell is lowest. Levels fall until nothing changes.
Raster<float> level_by_definition(Raster<float> const& dem, Raster<float> const& rivers) {
    Raster<float> level(dem.grid(), std::numeric_limits<float>::infinity());
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (std::isnan(dem[i]) || !std::isnan(rivers[i]) || plain::is_way_out(dem, i)) {
            level[i] = dem[i];
        }
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            plain::beside(dem.grid(), i, [&](std::int64_t n) {
                if (float const here = std::max(dem[i], level[n]); here < level[i]) {
                    level[i] = here;
                    changed = true;
                }
            });
        }
    }
    return level;
}

struct FloodScene {
    Raster<float> dem;
    Raster<float> rivers;
};

FloodScene any_flood_scene() {
    auto const width = *rc::gen::inRange<std::int64_t>(1, 12).as("width");
    auto const height = *rc::gen::inRange<std::int64_t>(1, 12).as("height");
    auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30).as("seed");
    auto const steps = *rc::gen::element<std::uint64_t>(1, 4, 1000).as("steps");
    float const step = *rc::gen::element(1.0F, flow::small_step).as("step"); // sloping lakes reach over small ones
    Grid const grid = frame(width, height);
    FloodScene scene{Raster<float>(grid), Raster<float>(grid, plain::no_data)};
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        auto const at = static_cast<std::uint64_t>(i);
        scene.dem[i] = random_word(seed, 1, at) % 12 == 0 ? plain::no_data
                                                          : step * static_cast<float>(random_word(seed, 2, at) % steps);
        if (!std::isnan(scene.dem[i]) && random_word(seed, 3, at) % 12 == 0) {
            scene.rivers[i] = scene.dem[i];
        }
    }
    return scene;
}

bool same_bytes(Raster<float> const& a, Raster<float> const& b) {
    return a.grid() == b.grid() && std::memcmp(a.values().data(), b.values().data(), a.values().size_bytes()) == 0;
}

bool same_change(flow::DemChange const& a, flow::DemChange const& b) {
    return a.raised_cells == b.raised_cells && a.cut_cells == b.cut_cells && a.max_raise_m == b.max_raise_m &&
           a.max_cut_m == b.max_cut_m && a.raised_m3 == b.raised_m3 && a.cut_m3 == b.cut_m3;
}

void change_cell(Scene& scene, std::int64_t at, int how) {
    float& here = scene.dem[at];
    switch (how) {
    case 0: here = flow::just_below(here); break;
    case 1: here = std::nextafter(here, -1.0F); break;
    case 2:
    case 3: here -= 3.0F; break; // a pit, or a bank below its river
    case 4: here += 3.0F; break;
    case 5: here = scene.dem[std::max<std::int64_t>(at - 1, 0)]; break;
    case 6: here = no_data; break;
    default: scene.valley.z[at] = here; break; // a sink
    }
    if (!std::isnan(scene.valley.z[at])) {
        scene.valley.z[at] = here;
    }
}

/// Land that drains, by its banks or only by its rivers, or all but for a few cells; or that mostly does not.
Scene any_nearly_drained_scene() {
    Scene scene = any_scene();
    if (*rc::gen::inRange(0, 6).as("as it is if 0") == 0) {
        return scene;
    }
    if (*rc::gen::arbitrary<bool>().as("banks")) {
        scene.dem = confine_channels(scene.dem, scene.valley).dem;
    }
    scene.dem = plain::filled(scene.dem, scene.valley);
    auto const changes = *rc::gen::inRange(0, 4).as("changes");
    for (int k = 0; k < changes; ++k) {
        auto const at = *rc::gen::inRange<std::int64_t>(0, scene.dem.cells()).as("cell");
        change_cell(scene, at, *rc::gen::inRange(0, 8).as("change"));
    }
    return scene;
}

std::string refused(Raster<float> const& dem, Valley const& valley) {
    return message_of<BadInput>([&] { check_drainable(dem, valley); });
}

} // namespace

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

TEST(Carve, FillsWhereNothingMayBeCut) {
    ASSERT_TRUE(rc::check("the least filling, bit for bit", [] {
        Raster<float> const dem = any_carve_land();
        Raster<float> const out = carved(dem, dem);
        Raster<float> const filled = plain::filled(dem, {any_depth(dem.grid())});
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            RC_ASSERT((std::isnan(dem[i]) ? std::isnan(out[i]) : out[i] == filled[i]));
        }
    }));
}

TEST(Carve, DrainsWithNoMoreVolumeThanFilling) {
    ASSERT_TRUE(rc::check("drained, nothing cut below its least, no more moved than by filling", [] {
        Raster<float> const dem = any_carve_land();
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30).as("least");
        Raster<float> least = any_depth(dem.grid());
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            if (random_word(seed, static_cast<std::uint64_t>(i)) % 3 == 0) {
                least[i] = dem[i] - 2.0F;
            }
        }
        Raster<float> const out = carved(dem, least);
        double moved = 0.0;
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            if (std::isnan(dem[i])) {
                RC_ASSERT(std::isnan(out[i]));
                continue;
            }
            bool lower = plain::is_way_out(dem, i);
            plain::beside(dem.grid(), i, [&](std::int64_t n) { lower = lower || out[n] < out[i]; });
            RC_ASSERT(lower);
            RC_ASSERT(!(out[i] < least[i]));
            moved += std::fabs(static_cast<double>(out[i]) - static_cast<double>(dem[i]));
        }
        RC_ASSERT(moved <= plain::fill_volume(dem) + 1e-3 * static_cast<double>(dem.cells()));
    }));
}

TEST(Carve, WhatDrainsAlreadyIsRecognisedAndStaysAsItIs) {
    int drained = 0;
    int undrained = 0;
    ASSERT_TRUE(rc::check("as carved and filled without looking first, bit for bit, with the same changes", [&] {
        Scene const scene = *rc::gen::resize(rc::kNominalSize, rc::gen::exec(any_nearly_drained_scene));
        Raster<float> const filled = flooded(scene.dem, scene.valley.z, Lakes::slope);
        bool const drains = flow::undrained_cells(scene.dem, scene.valley.z, {}).empty();
        ++(drains ? drained : undrained);
        RC_ASSERT(drains == same_bytes(filled, scene.dem));
        RC_ASSERT(same_bytes(fill(scene.dem, scene.valley), filled));
        Banks const banks = confine_channels(scene.dem, scene.valley);
        Raster<float> const carved = carve_depressions(banks.dem, scene.valley, flow::sparse_heights(banks.least), {});
        RC_ASSERT(same_bytes(carve(banks.dem, scene.valley, banks.least), carved));
        ConditionedDem const land = condition(scene.dem, scene.valley);
        RC_ASSERT(same_bytes(land.dem, carved));
        RC_ASSERT(same_change(land.banks, flow::change_between(scene.dem, banks.dem)));
        RC_ASSERT(same_change(land.depressions, flow::change_between(banks.dem, carved)));
    }));
    EXPECT_GT(drained, 0);
    EXPECT_GT(undrained, 0);
}

TEST(Carve, RefusesSparseHeightsOfAnotherGrid) {
    Raster<float> const dem(frame(4, 4));
    EXPECT_THROW(carved(dem, any_depth(frame(4, 5))), BadInput);
    EXPECT_THROW(carved(Raster<float>(), Raster<float>()), BadInput);
}

TEST(Carve, DrainsAndKeepsRivers) {
    ASSERT_TRUE(rc::check("drain by carving", [] {
        Scene const scene = any_scene();
        Banks const banks = confine_channels(scene.dem, scene.valley);
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

TEST(ConfineChannels, RefusesAMarginBelowZeroAndOtherFrames) {
    Grid const grid = frame(3, 3);
    EXPECT_THROW(confine_channels(Raster<float>(grid), no_rivers(grid), {-1.0}), BadParameter);
    EXPECT_THROW(confine_channels(Raster<float>(grid), no_rivers(frame(3, 2))), BadInput);
}

TEST(ConfineChannels, BanksKeepTheRiversWater) {
    ASSERT_TRUE(rc::check("raise_banks", [] {
        Scene const scene = any_scene();
        Banks const banks = confine_channels(scene.dem, scene.valley);
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
        Banks tight = confine_channels(scene.dem, scene.valley, none);
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

TEST(Fill, RefusesNoCellsAndOtherFrames) {
    EXPECT_THROW(fill(Raster<float>{}, Valley{}), BadInput);
    EXPECT_THROW(fill(Raster<float>(frame(3, 3)), no_rivers(frame(3, 2))), BadInput);
}

TEST(Fill, FillIsTheLeastThatDrains) {
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

TEST(Flood, LevelLakesStandAtTheLowestWayOut) {
    ASSERT_TRUE(rc::check("the least of the highest cells of all ways out, bit for bit", [] {
        FloodScene const scene = any_flood_scene();
        Raster<float> const level = flooded(scene.dem, scene.rivers, Lakes::level);
        Raster<float> const slowly = level_by_definition(scene.dem, scene.rivers);
        for (std::int64_t i = 0; i < level.cells(); ++i) {
            RC_ASSERT((std::isnan(level[i]) ? std::isnan(scene.dem[i]) : level[i] == slowly[i]));
        }
    }));
}

TEST(Flood, SlopingLakesFallToTheirOutlets) {
    ASSERT_TRUE(rc::check("the least surface that falls, bit for bit", [] {
        FloodScene const scene = any_flood_scene();
        Raster<float> const level = flooded(scene.dem, scene.rivers, Lakes::slope);
        Raster<float> const slowly = plain::filled(scene.dem, {scene.rivers});
        for (std::int64_t i = 0; i < level.cells(); ++i) {
            RC_ASSERT((std::isnan(level[i]) ? std::isnan(scene.dem[i]) : level[i] == slowly[i]));
        }
    }));
}

TEST(Flood, RefusesWhatCannotBeDrained) {
    Raster<float> dem(frame(3, 2), 1.0F);
    Valley valley{Raster<float>(dem.grid(), plain::no_data)};
    EXPECT_EQ(refused(dem, valley), "");
    EXPECT_TRUE(test::has(refused(Raster<float>(), valley), "no cells"));
    EXPECT_TRUE(test::has(refused(Raster<float>(frame(2, 3), 1.0F), valley), "3 x 2"));
    dem[Cell{2, 1}] = std::numeric_limits<float>::infinity();
    EXPECT_TRUE(test::has(refused(dem, valley), "column 2, row 1 is infinite"));
    dem[Cell{2, 1}] = plain::no_data;
    EXPECT_EQ(refused(dem, valley), "");
    valley.z[Cell{2, 1}] = 0.0F;
    EXPECT_TRUE(test::has(refused(dem, valley), "missing, where a river runs"));
}

} // namespace condition_test
