// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/route.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>
#include <measure/dems.hpp>
#include <rapidcheck.h>

namespace flow_lengths_test {

using namespace thalweg;
using flow::flow_lengths;
using flow::FlowField;
using flow::route;

TEST(FlowLengths, AreZeroWithoutDataAndWhereNoWaterArrives) {
    for (Raster<float> const& dem : {Raster<float>(frame(3, 2), hole), dem_of(1, {4})}) {
        Raster<float> const lengths = flow_lengths(route(dem));
        for (float const length : lengths.values()) {
            EXPECT_EQ(length, 0.0F);
        }
    }
}

TEST(FlowLengths, AreTheLongestWayDownToACell) {
    ASSERT_TRUE(rc::check("as walking down from every cell finds", [] {
        Raster<float> const dem = *gen_dem(12, 20);
        FlowField const drainage = route(dem);
        Grid const& grid = dem.grid();
        std::vector<double> longest(static_cast<std::size_t>(grid.cells()), 0.0);
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            double length = 0.0;
            for (std::int64_t at = i; goes_on(drainage.direction[at]);) {
                Cell const step = d8_steps[index_of(drainage.direction[at])];
                length += grid.cell_m * std::sqrt(static_cast<double>(step.col * step.col + step.row * step.row));
                at += step.row * grid.width + step.col;
                double& here = longest[static_cast<std::size_t>(at)];
                here = std::max(here, length);
            }
        }
        auto const fast = flow_lengths(drainage);
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            double const slow = longest[static_cast<std::size_t>(i)];
            RC_ASSERT(std::fabs(static_cast<double>(fast[i]) - slow) <= 1e-5 * slow);
        }
    }));
}

} // namespace flow_lengths_test
