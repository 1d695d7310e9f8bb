// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/texture/texture.hpp>

#include <cmath>
#include <map>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/route.hpp>

#include "dems.hpp"

namespace straight_channels_test {

using namespace thalweg;
using flow::route;
using measure::straight_channels;
using measure::StraightChannels;

namespace {

/// A valley along the middle row of a plane that falls to the east.
Raster<float> valley(std::int64_t width) {
    return test::raster_of(frame(width, 9), [&](Cell at) {
        return static_cast<float>(width - at.col) + 4.0F * std::fabs(static_cast<float>(at.row - 4));
    });
}

} // namespace

TEST(StraightChannels, RefusesNonsense) {
    flow::FlowField const drainage = route(rough_dem(frame(9, 9), 1));
    EXPECT_THROW(straight_channels(drainage, {.support_cells = 0}), BadParameter);
    EXPECT_THROW(straight_channels(drainage, {.reach_steps = 1}), BadParameter);
    EXPECT_THROW(straight_channels(drainage, {.tolerance_cells = -1.0}), BadParameter);
    EXPECT_THROW(straight_channels(drainage, {.tolerance_cells = std::nan("")}), BadParameter);
}

TEST(StraightChannels, NoneWithoutChannels) {
    StraightChannels const found = straight_channels(route(rough_dem(frame(9, 9), 1)));
    EXPECT_EQ(found.longest_run, 0);
    EXPECT_EQ(found.reaches, 0);
    EXPECT_TRUE(std::isnan(found.straight_share));
}

TEST(StraightChannels, AStraightValleyIs) {
    StraightChannels const found = straight_channels(route(valley(100)), {.support_cells = 20, .reach_steps = 10});
    EXPECT_GE(found.longest_run, 95);
    EXPECT_EQ(found.straight_share, 1.0);
    EXPECT_GE(found.reaches, 85);
}

TEST(StraightChannels, AsCountedDownstream) {
    ASSERT_TRUE(rc::check("runs by area from the sources down, reaches by their chord", [] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        Raster<float> dem = rough_dem(frame(40, 50), seed);
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            dem[i] += 0.1F * static_cast<float>(dem.grid().at(i).row);
        }
        flow::FlowField const drainage = route(dem);
        std::multimap<std::int64_t, std::int64_t> by_area;
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            if (drainage.area_cells[i] >= 15 && drainage.receiver(i) >= 0) {
                by_area.emplace(drainage.area_cells[i], i);
            }
        }
        std::map<std::int64_t, std::int64_t> run_to; // steps in the cell's own direction, itself included
        std::int64_t longest = 0;
        std::int64_t reaches = 0;
        std::int64_t straight = 0;
        for (auto const& [area, cell] : by_area) {
            std::int64_t const steps = ++run_to[cell];
            longest = std::max(longest, steps);
            std::int64_t const below = drainage.receiver(cell);
            if (drainage.direction[below] == drainage.direction[cell]) {
                run_to[below] = std::max(run_to[below], steps);
            }
            std::vector<Cell> reach{dem.grid().at(cell)};
            for (std::int64_t at = drainage.receiver(cell); at >= 0 && reach.size() < 9; at = drainage.receiver(at)) {
                reach.push_back(dem.grid().at(at));
            }
            if (reach.size() < 9) {
                continue;
            }
            ++reaches;
            auto const dx = static_cast<double>(reach.back().col - reach.front().col);
            auto const dy = static_cast<double>(reach.back().row - reach.front().row);
            double const chord = std::sqrt(dx * dx + dy * dy);
            bool near = chord >= 1.0;
            for (Cell const at : reach) {
                double const across = std::fabs(static_cast<double>(at.row - reach.front().row) * dx -
                                                static_cast<double>(at.col - reach.front().col) * dy);
                near = near && across <= 1.0 * chord;
            }
            straight += near ? 1 : 0;
        }
        StraightChannels const found =
            straight_channels(drainage, {.support_cells = 15, .reach_steps = 8, .tolerance_cells = 1.0});
        RC_ASSERT(found.longest_run == longest);
        RC_ASSERT(found.reaches == reaches);
        RC_ASSERT(reaches == 0 || found.straight_share == static_cast<double>(straight) / static_cast<double>(reaches));
    }));
}

} // namespace straight_channels_test
