// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/conditioning/internal/carve.hpp>

#include <cstdint>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/conditioning/dem_change.hpp>
#include <thalweg/flow/conditioning/internal/fill.hpp>
#include <thalweg/flow/conditioning/internal/raise_banks.hpp>

#include "conditioning/scenes.hpp"
#include "plain_drainage.hpp"

using namespace thalweg;
using flow::Banks;
using flow::carve;
using flow::fill;
using flow::raise_banks;
using scenes::any_scene;
using scenes::frame;
using scenes::no_rivers;
using scenes::require_drained;
using scenes::require_rivers_untouched;
using scenes::require_water_kept;
using scenes::Scene;

TEST(Carve, RefusesLeastHeightsOfAnotherFrame) {
    Grid const grid = frame(3, 3);
    EXPECT_THROW(carve(Raster<float>(grid), no_rivers(grid), Raster<float>(frame(2, 3))), BadInput);
}

TEST(Carve, CarveDrainsAndKeepsRivers) {
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
