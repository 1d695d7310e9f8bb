// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/internal/condition.hpp>

#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <thalweg/core/run/error.hpp>

#include "conditioning/scenes.hpp"
#include "plain_drainage.hpp"

namespace fill_test {

using namespace thalweg;
using flow::fill;
using scenes::any_scene;
using scenes::no_rivers;
using scenes::require_drained;
using scenes::require_rivers_untouched;
using scenes::Scene;
using test::frame;

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

} // namespace fill_test
