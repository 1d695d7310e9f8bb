// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/blend/paste.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

#include "lands.hpp"
#include "oracle.hpp"

namespace place_patch_test {

using namespace thalweg;
using namespace thalweg::blend;

namespace {

using test::full_message_of;
using test::on_threads;

std::string refused(Raster<float> const& source, Grid const& target, PlacePatchParams const& params) {
    return full_message_of<BadInput>([&] { place_patch(source, target, params); });
}

/// Cells without data at the edge, and those without data beside such, until there are no more.
Mask beyond_outline(Raster<float> const& source) {
    Grid const& grid = source.grid();
    Mask beyond(grid);
    for (std::int64_t round = 0; round < grid.cells(); ++round) {
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            Cell const c = grid.at(i);
            bool reaches = grid.on_border(c);
            for (Cell const n : oracle::around(grid, c)) {
                reaches = reaches || beyond[n] != 0;
            }
            if (reaches && std::isnan(source[i])) {
                beyond[i] = 1;
            }
        }
    }
    return beyond;
}

std::int64_t count(Mask const& mask) {
    std::int64_t cells = 0;
    for (std::uint8_t const m : mask.values()) {
        cells += m != 0 ? 1 : 0;
    }
    return cells;
}

} // namespace

TEST(PlacePatch, RefusesWhatCannotBePlaced) {
    Grid const grid = test::frame(6, 5, 10.0);
    Raster<float> const source = lands::by_chance(grid, 1);
    double const inf = std::numeric_limits<double>::infinity();
    EXPECT_THROW(place_patch(source, grid, {.rotate_deg = std::nan("")}), BadParameter);
    EXPECT_THROW(place_patch(source, grid, {.rotate_deg = 361.0}), BadParameter);
    EXPECT_THROW(place_patch(source, grid, {.scale = 0.0}), BadParameter);
    EXPECT_THROW(place_patch(source, grid, {.scale = inf}), BadParameter);
    EXPECT_THROW(place_patch(source, grid, {.gain = inf}), BadParameter);
    EXPECT_THROW(place_patch(source, grid, {.at = Vec2{inf, 0.0}}), BadParameter);
    for (SourceWindow const& w :
         {SourceWindow{0, 0, 7, 5}, SourceWindow{-1, 0, 3, 3}, SourceWindow{4, 0, 3, 3}, SourceWindow{0, 3, 3, 3},
          SourceWindow{0, 0, 0, 3}, SourceWindow{std::numeric_limits<std::int64_t>::max(), 0, 2, 2}}) {
        EXPECT_NE(refused(source, grid, {.window = w}).find("of a source of 6 x 5 cells"), std::string::npos);
    }
    EXPECT_NE(refused(Raster<float>{}, grid, {}).find("a window of 0 x 0"), std::string::npos);
    EXPECT_NE(refused(source, grid, {.part = Mask(test::frame(5, 6, 10.0), 1)}).find("they share a grid"),
              std::string::npos);
    EXPECT_EQ(refused(source, grid, {.part = Mask(grid)}), "blend.place_patch: the mask holds no cell of the target");
    EXPECT_EQ(refused(source, grid, {.at = Vec2{500.0, 25.0}}),
              "blend.place_patch: the patch of 6 x 5 source cells with its corners at (470.000, 50.000), (530.000, "
              "50.000), (530.000, 0.000) and (470.000, 0.000) covers no cell of the target, which reaches from (0.000, "
              "0.000) to (60.000, 50.000), that has all its neighbours on the source: move it or take a larger one");
    EXPECT_NE(refused(source, grid, {.at = Vec2{1e300, -1e300}}).find("covers no cell"), std::string::npos);
    EXPECT_NE(refused(source, Grid{}, {}).find("covers no cell"), std::string::npos);
    // A source of one cell has no neighbours.
    EXPECT_NE(refused(lands::by_chance(test::frame(1, 1, 10.0), 1), grid, {.at = Vec2{35.0, 25.0}}).find("1 x 1"),
              std::string::npos);
    Grid const one = test::frame(1, 1, 10.0);
    Patch const alone = place_patch(lands::by_chance(one, 1), one);
    EXPECT_EQ(alone.mask[0], 1); // all its neighbours there are
}

TEST(PlacePatch, WholeStepsTakeHeightsAsTheyStand) {
    ASSERT_TRUE(rc::check("shifted by cells, in coordinates of millions", [] {
        double const cell_m = *rc::gen::element(1.0, 30.0, 0.1, 29.7).as("cell");
        Grid target = test::frame(14, 11, cell_m);
        target.west = *rc::gen::element(0.0, 500000.3).as("west");
        target.north = *rc::gen::element(0.0, 4649776.22).as("north");
        auto const dx = *rc::gen::inRange<std::int64_t>(-8, 12).as("columns");
        auto const dy = *rc::gen::inRange<std::int64_t>(-8, 12).as("rows");
        Grid frame = target;
        frame.width = 7;
        frame.height = 6;
        frame.west += static_cast<double>(dx) * cell_m;
        frame.north -= static_cast<double>(dy) * cell_m;
        Raster<float> const source = lands::by_chance(frame, *rc::gen::inRange<std::uint64_t>(0, 1000).as("seed"), 0.1);
        Mask const beyond = beyond_outline(source);
        double const gain = *rc::gen::element(1.0, -2.0).as("gain");
        Mask covered(target);
        for (std::int64_t i = 0; i < target.cells(); ++i) {
            Cell const c = target.at(i);
            auto const there = [&](std::int64_t x, std::int64_t y) {
                Cell const n{c.col + x, c.row + y};
                Cell const from{n.col - dx, n.row - dy};
                return !target.contains(n) || (frame.contains(from) && beyond[from] == 0);
            };
            covered[i] = there(0, 0) && there(1, 0) && there(-1, 0) && there(0, 1) && there(0, -1) ? 1 : 0;
        }
        if (count(covered) == 0) {
            RC_ASSERT_THROWS_AS(place_patch(source, target, {.gain = gain}), BadInput);
            return;
        }
        Patch const patch = place_patch(source, target, {.gain = gain});
        for (std::int64_t i = 0; i < target.cells(); ++i) {
            Cell const own{target.at(i).col - dx, target.at(i).row - dy};
            RC_ASSERT(patch.mask[i] == covered[i]);
            if (frame.contains(own) && !std::isnan(source[own])) {
                RC_ASSERT(patch.z[i] == gain * static_cast<double>(source[own]));
            } else {
                RC_ASSERT(std::isnan(patch.z[i]));
            }
        }
    }));
}

TEST(PlacePatch, QuarterTurnsMoveCells) {
    Grid const grid = test::frame(9, 9, 30.0);
    Raster<float> const source = lands::by_chance(grid, 3);
    Patch const quarter = place_patch(source, grid, {.rotate_deg = 90.0});
    Patch const half = place_patch(source, grid, {.rotate_deg = -180.0});
    Patch const whole = place_patch(source, grid, {.rotate_deg = 360.0});
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        Cell const c = grid.at(i);
        // What lay in the east lies in the north.
        ASSERT_EQ(quarter.z[i], (source[{8 - c.row, c.col}]));
        ASSERT_EQ(half.z[i], (source[{8 - c.col, 8 - c.row}]));
        ASSERT_EQ(whole.z[i], source[i]);
        ASSERT_EQ(quarter.mask[i], 1);
    }
}

TEST(PlacePatch, APlaneStaysAPlane) {
    ASSERT_TRUE(rc::check("moved, turned and scaled as the formula says", [] {
        Grid const frame{30, 25, 10.0, 1000.0, 2000.0, ""};
        Raster<float> source(frame);
        for (std::int64_t i = 0; i < source.cells(); ++i) {
            Vec2 const p = frame.centre(frame.at(i));
            source[i] = static_cast<float>(0.5 * p.x - 0.25 * p.y);
        }
        Grid const target{40, 40, *rc::gen::element(4.0, 10.0, 17.0).as("cell"), -300.0, 300.0, ""};
        double const angle = *rc::gen::inRange(-360, 361).as("degrees");
        double const scale = *rc::gen::element(0.5, 1.0, 2.3).as("scale");
        Vec2 const at{-300.0 + 20.0 * target.cell_m + 1.7, 300.0 - 20.0 * target.cell_m - 3.3};
        Patch const patch = place_patch(source, target, {.at = at, .rotate_deg = angle, .scale = scale, .gain = 3.0});
        std::int64_t covered = 0;
        for (std::int64_t i = 0; i < target.cells(); ++i) {
            if (std::isnan(patch.z[i])) {
                continue;
            }
            ++covered;
            Vec2 const p = target.centre(target.at(i));
            double const turn = -angle * 3.14159265358979323846 / 180.0;
            double const x = 1150.0 + (std::cos(turn) * (p.x - at.x) - std::sin(turn) * (p.y - at.y)) / scale;
            double const y = 1875.0 + (std::sin(turn) * (p.x - at.x) + std::cos(turn) * (p.y - at.y)) / scale;
            RC_ASSERT(std::fabs(patch.z[i] - 3.0 * (0.5 * x - 0.25 * y)) <= 1e-3);
        }
        double const area = 290.0 * 240.0 * scale * scale / (target.cell_m * target.cell_m);
        RC_ASSERT((covered > 20 && static_cast<double>(covered) < 1.2 * area + 50.0));
    }));
}

TEST(PlacePatch, BetweenCentresNextToNoDataNothingIsKnown) {
    Grid const frame = test::frame(4, 3);
    Raster<float> source = lands::by_chance(frame, 2);
    source[{2, 1}] = lands::nan;
    Grid target = frame;
    target.west += 0.25;
    Patch const patch = place_patch(source, target);
    for (std::int64_t i = 0; i < target.cells(); ++i) {
        Cell const c = target.at(i);
        bool const known = c.col < 3 && !(c.row == 1 && (c.col == 1 || c.col == 2));
        ASSERT_EQ(std::isnan(patch.z[i]), !known) << c.col << " " << c.row;
        if (known) {
            double const z = source[i];
            ASSERT_EQ(patch.z[i], z + 0.25 * (static_cast<double>(source[i + 1]) - z));
        }
        ASSERT_EQ(patch.mask[i], c.col < 2 ? 1 : 0); // a hole is part of the mask, the lattice's edge is not
    }
}

TEST(PlacePatch, WindowAndPartSayWhatIsCovered) {
    Grid const grid = test::frame(20, 16, 30.0);
    Raster<float> const source = lands::by_chance(grid, 4);
    Patch const patch = place_patch(source, grid, {.window = SourceWindow{3, 2, 5, 4}});
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        Cell const c = grid.at(i);
        ASSERT_EQ(patch.mask[i], c.col >= 3 && c.col < 8 && c.row >= 2 && c.row < 6 ? 1 : 0);
        if (c.col >= 2 && c.col <= 8 && c.row >= 1 && c.row <= 6) {
            ASSERT_EQ(patch.z[i], source[i]); // beside the window there is land too
        }
    }
    // Its centre comes to lie where it is asked for.
    Patch const moved = place_patch(
        source, grid, {.at = Vec2{30.0 * 12.5, grid.north - 30.0 * 8.0}, .window = SourceWindow{3, 2, 5, 4}});
    EXPECT_EQ(count(moved.mask), 20);
    EXPECT_EQ((moved.z[{10, 6}]), (source[{3, 2}]));
    EXPECT_EQ((moved.mask[{10, 6}]), 1);
    EXPECT_EQ((moved.mask[{14, 9}]), 1);
    Patch const part =
        place_patch(source, grid, {.window = SourceWindow{3, 2, 5, 4}, .part = lands::block(grid, {6, 0}, {9, 3})});
    EXPECT_EQ(count(part.mask), 4);
    EXPECT_EQ(part.outside, 12);
}

TEST(PlacePatch, TheSameBitsOnAnyNumberOfThreads) {
    Raster<float> const source = lands::by_chance(test::frame(60, 50, 3.0), 4);
    Grid const target = test::frame(90, 80, 2.0);
    thalweg::Run const one = on_threads(1);
    thalweg::Run const four = on_threads(4);
    PlacePatchParams const params{.rotate_deg = 33.0};
    Patch const a = place_patch(source, target, params, one);
    Patch const b = place_patch(source, target, params, four);
    for (std::int64_t i = 0; i < target.cells(); ++i) {
        ASSERT_TRUE(a.z[i] == b.z[i] || (std::isnan(a.z[i]) && std::isnan(b.z[i])));
        ASSERT_EQ(a.mask[i], b.mask[i]);
    }
}

} // namespace place_patch_test
