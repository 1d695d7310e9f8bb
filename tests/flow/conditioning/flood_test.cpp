// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/internal/condition.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>

#include "conditioning/scenes.hpp"
#include "plain_drainage.hpp"

namespace flood_test {

using namespace thalweg;
using flow::check_drainable;
using flow::flood;
using flow::Lakes;
using test::frame;

namespace {

using test::message_of;

Raster<float> flooded(Raster<float> const& dem, Raster<float> const& rivers, Lakes lakes) {
    Raster<float> level = framed(dem);
    flood(level, framed(rivers), lakes, {});
    return unframed(level, dem.grid());
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
    Grid const grid = frame(width, height);
    FloodScene scene{Raster<float>(grid), Raster<float>(grid, plain::no_data)};
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        auto const at = static_cast<std::uint64_t>(i);
        scene.dem[i] =
            random_word(seed, 1, at) % 12 == 0 ? plain::no_data : static_cast<float>(random_word(seed, 2, at) % steps);
        if (!std::isnan(scene.dem[i]) && random_word(seed, 3, at) % 12 == 0) {
            scene.rivers[i] = scene.dem[i];
        }
    }
    return scene;
}

std::string refused(Raster<float> const& dem, Valley const& valley) {
    return message_of<BadInput>([&] { check_drainable(dem, valley); });
}

} // namespace

TEST(Flood, LeavesAloneWhatHasNoInside) {
    for (auto const& [width, height] : {std::pair<std::int64_t, std::int64_t>{1, 1}, {1, 5}, {2, 2}, {5, 2}}) {
        Raster<float> dem(frame(width, height));
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            dem[i] = static_cast<float>((7 * i) % 5);
        }
        Raster<float> const none(dem.grid(), plain::no_data);
        for (Lakes const lakes : {Lakes::level, Lakes::slope}) {
            Raster<float> const level = flooded(dem, none, lakes);
            for (std::int64_t i = 0; i < dem.cells(); ++i) {
                EXPECT_EQ(level[i], dem[i]);
            }
        }
    }
}

TEST(Flood, KeepsNoData) {
    Raster<float> const nothing(frame(3, 3), plain::no_data);
    Raster<float> const level = flooded(nothing, nothing, Lakes::slope);
    for (std::int64_t i = 0; i < level.cells(); ++i) {
        EXPECT_TRUE(std::isnan(level[i]));
    }
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
    EXPECT_NE(refused(Raster<float>(), valley).find("no cells"), std::string::npos);
    EXPECT_NE(refused(Raster<float>(frame(2, 3), 1.0F), valley).find("3 x 2"), std::string::npos);
    dem[Cell{2, 1}] = std::numeric_limits<float>::infinity();
    EXPECT_NE(refused(dem, valley).find("column 2, row 1 is infinite"), std::string::npos);
    dem[Cell{2, 1}] = plain::no_data;
    EXPECT_EQ(refused(dem, valley), "");
    valley.z[Cell{2, 1}] = 0.0F;
    EXPECT_NE(refused(dem, valley).find("missing, where a river runs"), std::string::npos);
}

} // namespace flood_test
