// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/blend/internal/region.hpp>

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "lands.hpp"

namespace region_test {

using namespace thalweg;
using blend::distance_within;

TEST(DistanceWithin, EqualsComparingAllCells) {
    ASSERT_TRUE(rc::check("to a float's rounding", [] {
        Grid const grid = test::frame(*rc::gen::inRange<std::int64_t>(1, 20).as("columns"),
                                      *rc::gen::inRange<std::int64_t>(1, 20).as("rows"));
        Mask const mask = lands::mask_by_chance(grid, *rc::gen::inRange<std::uint64_t>(0, 100000).as("seed"),
                                                *rc::gen::element(0.3, 0.9, 0.99).as("share"));
        Raster<float> const depth = distance_within(mask);
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            double nearest = std::numeric_limits<double>::infinity();
            for (std::int64_t k = 0; k < grid.cells(); ++k) {
                if (mask[k] == 0) {
                    nearest = std::min(nearest, distance(grid.centre(grid.at(i)), grid.centre(grid.at(k))));
                }
            }
            RC_ASSERT(depth[i] == static_cast<float>(nearest));
        }
    }));
}

} // namespace region_test
