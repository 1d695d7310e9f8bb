// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/internal/condition.hpp>

#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <thalweg/core/run/error.hpp>

#include "conditioning/scenes.hpp"
#include "plain_drainage.hpp"

namespace confine_channels_test {

using namespace thalweg;
using flow::Banks;
using flow::confine_channels;
using scenes::any_scene;
using scenes::beside;
using scenes::no_rivers;
using scenes::require_rivers_untouched;
using scenes::require_water_kept;
using scenes::Scene;
using test::frame;

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

} // namespace confine_channels_test
