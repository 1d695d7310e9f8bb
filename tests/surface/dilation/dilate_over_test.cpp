// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <gtest/gtest.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/surface/dilation/dilation.hpp>

#include "valleys.hpp"

namespace dilate_over_test {

namespace {

using namespace thalweg;
using namespace thalweg::surface;

Valley one_river(Grid const& grid) {
    Valley valley{Raster<float>(grid, std::nanf(""))};
    for (std::int64_t row = 0; row < grid.height; ++row) {
        valley.z[Cell{grid.width / 2, row}] = static_cast<float>(grid.height - row);
    }
    return valley;
}

DilateParams even_slopes() {
    DilateParams params;
    params.increment.increment = "uniform";
    return params;
}

} // namespace

TEST(DilateOver, RefusesABaseOfAnotherFrame) {
    Valley const valley = one_river(test::frame_below(5, 5));
    EXPECT_THROW(dilate_over(valley, Raster<float>(test::frame_below(5, 6))), BadInput);
}

TEST(DilateOver, HasNoHeightWhereTheBaseHasNone) {
    Valley const valley = one_river(test::frame_below(5, 5));
    Raster<float> base(valley.z.grid(), 1.0F);
    base[Cell{0, 3}] = std::nanf("");
    EXPECT_TRUE(std::isnan(dilate_over(valley, base).dem[Cell{0, 3}]));
}

TEST(DilateOver, RisesFromTheBaseAsADilationRisesFromLevelGround) {
    Grid const grid = test::frame_below(9, 7);
    Valley const valley = one_river(grid);
    Valley level = valley;
    for (float& z : level.z.values()) {
        z = std::isnan(z) ? z : 0.0F;
    }
    Raster<float> base(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        base[i] = static_cast<float>(i % 5) * 3.0F;
    }
    Dilated const rise = dilate(level, even_slopes());
    Dilated const land = dilate_over(valley, base, even_slopes());
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        EXPECT_EQ(land.dem[i], std::isnan(valley.z[i]) ? base[i] + rise.dem[i] : valley.z[i]);
    }
    EXPECT_EQ(land.levels, rise.levels);
}

TEST(DilateOver, CellsBehindABarrierStayWithout) {
    Grid const grid = test::frame_below(9, 7);
    Valley const valley = one_river(grid);
    Mask inside(grid, 1);
    for (std::int64_t row = 0; row < grid.height; ++row) {
        inside[Cell{2, row}] = 0;
    }
    Dilated const land = dilate_over(valley, Raster<float>(grid, 5.0F), inside, even_slopes());
    EXPECT_TRUE(std::isnan(land.dem[Cell{0, 3}]));
    EXPECT_TRUE(std::isnan(land.dem[Cell{2, 3}]));
    EXPECT_FALSE(std::isnan(land.dem[Cell{3, 3}]));
}

} // namespace dilate_over_test
