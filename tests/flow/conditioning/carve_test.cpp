// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/internal/condition.hpp>

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/condition.hpp>

#include "conditioning/scenes.hpp"
#include "plain_drainage.hpp"

namespace carve_test {

using namespace thalweg;
using flow::Banks;
using flow::carve;
using flow::confine_channels;
using flow::fill;
using scenes::any_scene;
using scenes::require_drained;
using scenes::require_rivers_untouched;
using scenes::require_water_kept;
using scenes::Scene;
using test::frame;

namespace {

Raster<float> any_depth(Grid const& grid) {
    return Raster<float>(grid, plain::no_data);
}

Raster<float> carved(Raster<float> const& dem, Raster<float> const& least) {
    return carve(dem, {Raster<float>(dem.grid(), plain::no_data)}, least);
}

/// Level land of a height, with another height in the middle, a ring of cells away from the border.
Raster<float> basin(std::int64_t side, float rim, float floor) {
    Raster<float> dem(frame(side, side), rim);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (Cell const c = dem.grid().at(i); c.col > 0 && c.row > 0 && c.col + 1 < side && c.row + 1 < side) {
            dem[i] = floor;
        }
    }
    return dem;
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

} // namespace

TEST(Carve, LeavesAloneWhatHasNoInside) {
    for (auto const& [width, height] : {std::pair<std::int64_t, std::int64_t>{1, 1}, {1, 6}, {2, 2}, {6, 2}}) {
        Raster<float> dem(frame(width, height));
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            dem[i] = static_cast<float>((7 * i) % 5);
        }
        Raster<float> const out = carved(dem, any_depth(dem.grid()));
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            EXPECT_EQ(out[i], dem[i]);
        }
    }
}

TEST(Carve, LeavesAloneWhatDrains) {
    Raster<float> dem = test::raster_of(frame(9, 7), [&](Cell c) { return 3 * c.col + 2 * c.row; });
    Raster<float> const out = carved(dem, any_depth(dem.grid()));
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        EXPECT_EQ(out[i], dem[i]);
    }
}

// Nine cells 10 m deep, behind a rim one cell wide: 10 m cells to cut, 90 to fill.
TEST(Carve, CutsTheRimOfAWideBasin) {
    Raster<float> const dem = basin(5, 10.0F, 0.0F);
    Raster<float> const out = carved(dem, any_depth(dem.grid()));
    int cut = 0;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (dem[i] == 0.0F) {
            EXPECT_NEAR(out[i], 0.0, 1e-3);
        } else if (out[i] != dem[i]) {
            EXPECT_NEAR(out[i], 0.0, 1e-3);
            ++cut;
        }
    }
    EXPECT_EQ(cut, 1);
}

// One cell 0.1 m deep, behind two cells: 0.2 m cells to cut, 0.1 to fill.
TEST(Carve, FillsAShallowPit) {
    Raster<float> dem(frame(5, 5), 10.0F);
    dem[Cell{2, 2}] = 9.9F;
    Raster<float> const out = carved(dem, any_depth(dem.grid()));
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        EXPECT_GE(out[i], dem[i]);
        EXPECT_NEAR(out[i], 10.0, 1e-3);
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

TEST(Carve, RefusesLeastHeightsOfAnotherGrid) {
    Raster<float> const dem = basin(4, 1.0F, 0.0F);
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

} // namespace carve_test
