// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/gaps/close_gaps.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>
#include <support.hpp>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/error.hpp>

namespace close_gaps_test {

using namespace thalweg;
using namespace thalweg::surface;

namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Rows of digits; '.' is no data, '-' is -1.
Raster<float> dem_of(std::vector<std::string> const& rows) {
    Grid const frame =
        test::frame(static_cast<std::int64_t>(rows.front().size()), static_cast<std::int64_t>(rows.size()), 10.0);
    return test::raster_of(frame, [&](Cell c) {
        char const z = rows[static_cast<std::size_t>(c.row)][static_cast<std::size_t>(c.col)];
        return z == '.' ? nan : z == '-' ? -1.0F : static_cast<float>(z - '0');
    });
}

std::vector<std::string> rows_of(Raster<float> const& dem) {
    std::vector<std::string> rows;
    for (std::int64_t row = 0; row < dem.height(); ++row) {
        rows.emplace_back();
        for (float const z : dem.row(row)) {
            rows.back() += std::isnan(z) ? '.' : z < 0 ? '-' : static_cast<char>('0' + static_cast<int>(z));
        }
    }
    return rows;
}

std::vector<std::string> const collar{"...555..", ".666666.", "77.77777", "77777..7", "7733.777", ".7777777"};

} // namespace

TEST(CloseGaps, CutsTheRimAndLevelsHolesAtTheirLowestShore) {
    ClosedGaps const closed = close_gaps(dem_of(collar));
    EXPECT_EQ(rows_of(closed.dem), (std::vector<std::string>{"666666", "767777", "777733", "733377", "777777"}));
    EXPECT_EQ(closed.first, (Cell{1, 1}));
    EXPECT_EQ(closed.dem.grid().north, dem_of(collar).grid().north - 10.0);
    EXPECT_EQ(closed.rim, 8);
    EXPECT_EQ(closed.enclosed, 4);
    EXPECT_EQ(closed.holes, 2);
    EXPECT_EQ(closed.cut, 10);
    EXPECT_EQ(closed.low_m, 3.0);
    EXPECT_EQ(closed.high_m, 6.0);
}

TEST(CloseGaps, FillsTheRimFromTheNearestCellOrWithTheLowestHeight) {
    ClosedGaps const near = close_gaps(dem_of(collar), {.rim = RimGaps::nearest});
    EXPECT_EQ(rows_of(near.dem),
              (std::vector<std::string>{"66555556", "66666666", "77677777", "77777337", "77333777", "77777777"}));
    EXPECT_EQ(near.cut, 0);
    ClosedGaps const low = close_gaps(dem_of(collar), {RimGaps::minimum, EnclosedGaps::minimum});
    EXPECT_EQ(rows_of(low.dem),
              (std::vector<std::string>{"33355533", "36666663", "77377777", "77777337", "77333777", "37777777"}));
}

TEST(CloseGaps, HolesTakeTheNearestCellWhereAsked) {
    ClosedGaps const closed = close_gaps(dem_of({"1239", "1..9", "1119"}), {.holes = EnclosedGaps::nearest});
    EXPECT_EQ(rows_of(closed.dem), (std::vector<std::string>{"1239", "1239", "1119"}));
    EXPECT_EQ(closed.enclosed, 2);
    EXPECT_EQ(closed.low_m, 2.0);
    EXPECT_EQ(closed.high_m, 3.0);
}

TEST(CloseGaps, TheSeaEndsAtDikes) {
    std::vector<std::string> const coast{"--05555", "--05--5", "-.05--5", "..05555"};
    ClosedGaps const closed = close_gaps(dem_of(coast), {.rim = RimGaps::sea, .sea_m = -0.5});
    EXPECT_EQ(rows_of(closed.dem)[3], "--05555"); // a gap of the rim
    EXPECT_EQ(std::ranges::count(closed.sea.values(), 1), 8);
    EXPECT_EQ(closed.dry, 4);
    ClosedGaps const dry = close_gaps(dem_of({"555", "5-5", "555"}), {.sea_m = 0.0});
    EXPECT_EQ(std::ranges::count(dry.sea.values(), 1), 0);
    EXPECT_EQ(dry.dry, 1);
}

TEST(CloseGaps, RefusesWhatCannotBeClosed) {
    EXPECT_TRUE(test::has(test::message_of<BadInput>([] {
                              close_gaps(dem_of({"..", ".."}));
                          }),
                          "no cell has a height"));
    EXPECT_TRUE(test::has(test::message_of<BadInput>([] {
                              close_gaps(dem_of({"5.5", "..5", "5.5"}));
                          }),
                          "2 x 2", "--rim nearest"));
    EXPECT_TRUE(test::has(test::message_of<BadParameter>([] {
                              close_gaps(dem_of({"55", "55"}), {.rim = RimGaps::sea});
                          }),
                          "level"));
}

RC_GTEST_PROP(CloseGaps, KeepsHeightsAndClosesAllGaps, ()) {
    auto const width = *rc::gen::inRange<std::int64_t>(2, 12);
    auto const height = *rc::gen::inRange<std::int64_t>(2, 12);
    auto const cells =
        *rc::gen::container<std::vector<int>>(static_cast<std::size_t>(width * height), rc::gen::inRange(-1, 14));
    Raster<float> dem(test::frame(width, height, 10.0));
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        int const z = cells[static_cast<std::size_t>(i)];
        dem[i] = z > 9 ? nan : static_cast<float>(z);
    }
    RC_PRE(std::ranges::any_of(dem.values(), [](float z) { return !std::isnan(z); }));
    CloseGapsParams params;
    params.rim = *rc::gen::element(RimGaps::nearest, RimGaps::minimum, RimGaps::sea);
    params.holes = *rc::gen::element(EnclosedGaps::shore, EnclosedGaps::nearest, EnclosedGaps::minimum);
    params.sea_m = 0.0;
    ClosedGaps const closed = close_gaps(dem, params);
    std::int64_t gaps = 0;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        RC_ASSERT(!std::isnan(closed.dem[i]));
        gaps += std::isnan(dem[i]) ? 1 : 0;
        RC_ASSERT(std::isnan(dem[i]) || closed.dem[i] == dem[i]);
        RC_ASSERT(closed.sea[i] == 0 || closed.dem[i] <= 0.0F);
    }
    RC_ASSERT(closed.rim + closed.enclosed == gaps);
}

RC_GTEST_PROP(CloseGaps, TheRectangleIsTheLargest, ()) {
    auto const width = *rc::gen::inRange<std::int64_t>(1, 8);
    auto const height = *rc::gen::inRange<std::int64_t>(1, 8);
    auto const cells =
        *rc::gen::container<std::vector<int>>(static_cast<std::size_t>(width * height), rc::gen::inRange(0, 4));
    Mask marked(test::frame(width, height, 1.0), 0);
    for (std::int64_t i = 0; i < marked.cells(); ++i) {
        marked[i] = cells[static_cast<std::size_t>(i)] == 0 ? 1 : 0;
    }
    auto const is_free = [&](Cell a, Cell b) {
        for (std::int64_t row = a.row; row <= b.row; ++row) {
            for (std::int64_t col = a.col; col <= b.col; ++col) {
                if (marked[Cell{col, row}] != 0) {
                    return false;
                }
            }
        }
        return true;
    };
    std::int64_t most = 0;
    for (std::int64_t i = 0; i < marked.cells(); ++i) {
        for (std::int64_t k = i; k < marked.cells(); ++k) {
            Cell const a = marked.grid().at(i);
            Cell const b = marked.grid().at(k);
            if (b.col >= a.col && is_free(a, b)) {
                most = std::max(most, (b.col - a.col + 1) * (b.row - a.row + 1));
            }
        }
    }
    Grid const found = largest_rectangle(marked);
    RC_ASSERT(found.cells() == most);
    if (most > 0) {
        Cell const first = marked.grid().cell_of(found.centre({0, 0}));
        RC_ASSERT(is_free(first, {first.col + found.width - 1, first.row + found.height - 1}));
    }
}

} // namespace close_gaps_test
