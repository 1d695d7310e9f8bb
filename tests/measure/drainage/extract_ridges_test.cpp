// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/drainage/certificate.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

namespace extract_ridges_test {

using namespace thalweg;
using namespace thalweg::measure;

namespace {

Grid const ground{80, 60, 10.0, 1000.0, 5000.0, ""};

/// A roof: its ridge along row 30, a little higher to the east.
Raster<float> roof() {
    return test::raster_of(ground, [&](Cell c) {
        return 500.0F - 3.0F * static_cast<float>(std::abs(c.row - 30)) + 0.5F * static_cast<float>(c.col);
    });
}

RidgeLines along_row(std::int64_t row) {
    Vec2 const west = ground.centre({0, row});
    Vec2 const east = ground.centre({79, row});
    return {{{{{west.x, west.y, 1.0}, {east.x, east.y, 1.0}}, 1, 2}}};
}

} // namespace

TEST(ExtractRidges, NothingIsAskedOrNothingIsThere) {
    EXPECT_EQ(extract_ridges(roof(), {}).ridge_cells, 0);
    EXPECT_EQ(extract_ridges(roof(), {}).threshold_cells, 0);
    Raster<float> const hole(ground, std::numeric_limits<float>::quiet_NaN());
    EXPECT_EQ(extract_ridges(hole, along_row(30)).ridge_cells, 0);
    RidgeLines outside = along_row(30);
    outside.lines[0].line[0].x -= 1000.0;
    EXPECT_THROW(extract_ridges(roof(), outside), BadInput);
}

TEST(ExtractRidges, FindsTheRidgeOfARoof) {
    ExtractedRidges const found = extract_ridges(roof(), along_row(30));
    EXPECT_EQ(found.ridge_cells, 80);
    EXPECT_GE(found.threshold_cells, 16);
    EXPECT_GT(found.extracted[0].f(), 0.95);
    EXPECT_GE(found.extracted[1].f(), found.extracted[0].f());
}

TEST(ExtractRidges, ARidgeThatTheDemHasNotIsMissed) {
    ExtractedRidges const found = extract_ridges(roof(), along_row(10));
    EXPECT_LT(found.extracted[1].f(), 0.3);
}

} // namespace extract_ridges_test
