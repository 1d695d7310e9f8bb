// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/blend/deform.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/blend/paste.hpp>
#include <thalweg/core/run/error.hpp>

#include "lands.hpp"
#include "oracle.hpp"

namespace deform_test {

using namespace thalweg;
using namespace thalweg::blend;

namespace {

using test::full_message_of;
using test::has;

std::string refused(Raster<float> const& target, Mask const& region, std::vector<Handle> const& handles) {
    return full_message_of<BadInput>([&] { deform(target, region, handles); });
}

} // namespace

TEST(Deform, RefusesWhatCannotBeBent) {
    Grid const grid = test::frame(6, 5);
    Raster<float> target = lands::by_chance(grid, 1);
    target[{2, 2}] = lands::nan;
    Mask const region = lands::block(grid, {1, 1}, {3, 3});
    EXPECT_THROW(deform(target, region, {}, {.scale = std::nan("")}), BadParameter);
    EXPECT_TRUE(has(refused(target, Mask(test::frame(5, 6)), {}), "they share a grid"));
    EXPECT_TRUE(has(refused(target, Mask(grid), {}), "no cell of the target would change"));
    EXPECT_TRUE(has(refused(Raster<float>(grid, lands::nan), region, {}), "no cell of the target would change"));
    EXPECT_TRUE(has(refused(target, Mask(grid, 1), {}), "has no neighbour with a height to join"));
    EXPECT_TRUE(has(refused(target, region, {{{6, 0}, 1.0}}), "column 6, row 0 to 1 m lies outside"));
    EXPECT_TRUE(has(refused(target, region, {{{0, 0}, 1.0}}), "lies in no cell of the region"));
    EXPECT_TRUE(has(refused(target, region, {{{2, 2}, 1.0}}), "lies in no cell of the region"));
    EXPECT_TRUE(has(refused(target, region, {{{1, 1}, std::nan("")}}), "is not a height"));
    EXPECT_TRUE(has(refused(target, region, {{{1, 1}, 5.0}, {{1, 1}, 6.0}}), "is there already, to 5 m"));
    EXPECT_EQ(deform(target, region, {{{1, 1}, 5.0}, {{1, 1}, 5.0}}).cells, 8);
    target[{3, 3}] = std::numeric_limits<float>::infinity();
    EXPECT_TRUE(has(refused(target, region, {}), "column 3, row 3 is infinite"));
}

TEST(Deform, ScaleOneAndHandlesWhereTheyAreChangeNothing) {
    ASSERT_TRUE(rc::check("bit for bit", [] {
        Grid const grid = test::frame(9, 8);
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 100000).as("seed");
        Raster<float> const target = lands::by_chance(grid, seed, 0.1);
        Mask const region = lands::mask_by_chance(grid, seed, 0.6);
        Mask const pulled = lands::mask_by_chance(grid, seed + 1, 0.1);
        std::vector<Handle> handles;
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            if (region[i] != 0 && pulled[i] != 0 && !std::isnan(target[i])) {
                handles.push_back({grid.at(i), static_cast<double>(target[i])});
            }
        }
        DeformedDem deformed;
        try {
            deformed = deform(target, region, handles);
        } catch (BadInput const&) {
            RC_DISCARD("a part hangs on nothing");
        }
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            RC_ASSERT(lands::same(deformed.dem[i], target[i]));
        }
    }));
}

TEST(Deform, EqualsThePasteOfTheScaledTarget) {
    // Handles are cells of another target that keep their height: the dense oracle knows those.
    ASSERT_TRUE(rc::check("heights of the oracle", [] {
        Grid const grid = test::frame(7, 8);
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 100000).as("seed");
        double const scale = *rc::gen::element(0.0, 1.0, 2.5, -1.0).as("scale");
        Raster<float> const target = lands::by_chance(grid, seed, 0.1);
        Mask const region = lands::mask_by_chance(grid, seed, 0.7);
        Mask const drawn = lands::mask_by_chance(grid, seed + 1, 0.15);
        Raster<float> pulled = target;
        Patch patch = lands::patch_of(target, region);
        PasteParams params;
        params.keep = Mask(grid);
        std::vector<Handle> handles;
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            patch.z[i] *= scale;
            if (region[i] != 0 && drawn[i] != 0 && !std::isnan(target[i])) {
                pulled[i] += 50.0F;
                params.keep[i] = 1;
                handles.push_back({grid.at(i), static_cast<double>(pulled[i])});
            }
        }
        // Across land without data nothing is wanted of the oracle either.
        auto const truth = oracle::paste({pulled, patch, params});
        if (!truth) {
            RC_ASSERT_THROWS_AS(deform(target, region, handles), BadInput);
            return;
        }
        DeformedDem deformed;
        try {
            deformed = deform(target, region, handles, {.scale = scale, .tolerance = 1e-12});
        } catch (BadInput const&) {
            RC_DISCARD("nothing to bend");
        }
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            if (std::isnan(target[i])) {
                RC_ASSERT(std::isnan(deformed.dem[i]));
            } else {
                RC_ASSERT(std::fabs(deformed.dem[i] - (*truth)[i]) <= 1e-6 * (100.0 + std::fabs((*truth)[i])));
            }
        }
    }));
}

TEST(Deform, AHandleAloneLiftsATent) {
    Grid const grid = test::frame(5, 5);
    Raster<float> const target(grid, 10.0F);
    DeformedDem const deformed = deform(target, lands::block(grid, {1, 1}, {3, 3}), {{{2, 2}, 22.0}});
    EXPECT_EQ((deformed.dem[{2, 2}]), 22.0F);
    EXPECT_FLOAT_EQ((deformed.dem[{2, 1}]), 14.0F); // sides s and corners c above 10: 4 s = 12 + 2 c, 4 c = 2 s
    EXPECT_FLOAT_EQ((deformed.dem[{1, 1}]), 12.0F);
    EXPECT_EQ((deformed.dem[{0, 2}]), 10.0F);
    EXPECT_EQ(deformed.cells, 9);
    DeformedDem const alone = deform(target, lands::block(grid, {2, 2}, {2, 2}), {{{2, 2}, 22.0}});
    EXPECT_EQ((alone.dem[{2, 2}]), 22.0F);
    EXPECT_EQ(alone.cells, 1);
    // All of the land may move when a handle holds it.
    DeformedDem const whole = deform(target, Mask(grid, 1), {{{4, 0}, 3.0}});
    for (float const z : whole.dem.values()) {
        EXPECT_FLOAT_EQ(z, 3.0F);
    }
}

TEST(Deform, ARegionTurnsAsAPatchOfTheTargetItself) {
    // A cone off the middle turns round it; its height stays.
    Grid const grid = test::frame(41, 41);
    Raster<float> target(grid);
    Vec2 const peak{26.5, 20.5};
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        target[i] = static_cast<float>(std::max(0.0, 30.0 - 10.0 * distance(grid.centre(grid.at(i)), peak)));
    }
    Mask part = test::raster_of<std::uint8_t>(grid, [&](Cell c) {
        return distance(grid.centre(c), {20.5, 20.5}) < 14.0 ? 1 : 0;
    });
    Patch const patch = place_patch(target, grid, {.at = Vec2{20.5, 20.5}, .rotate_deg = 90.0, .part = part});
    PastedDem const turned = paste(target, patch);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        Cell const c = grid.at(i);
        EXPECT_NEAR(turned.dem[i], (target[{40 - c.row, c.col}]), 1e-4);
    }
}

} // namespace deform_test
