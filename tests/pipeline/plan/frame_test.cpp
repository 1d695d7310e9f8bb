// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/plan/frame.hpp>

#include <algorithm>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

namespace frame_test {

using namespace thalweg;
using namespace thalweg::pipeline;

namespace {

using test::has;
using test::message_of;

RiverLines one_river(std::vector<Vec3> vertices) {
    RiverLines lines;
    lines.lines.push_back({3, std::move(vertices), "", 0});
    lines.crs = "EPSG:32631";
    lines.name = "rivers.gpkg";
    return lines;
}

} // namespace

TEST(Frame, MemoryIsAskedBeforeTheWork) {
    EXPECT_NO_THROW(check_memory(10, 10));
    EXPECT_THROW(check_memory(1000000, 1000000), BadInput);
    EXPECT_NO_THROW(check_memory_of_cluster(10));
    EXPECT_THROW(check_memory_of_cluster(std::int64_t{1} << 50), BadInput);
}

TEST(Frame, OneCell) {
    FramedBranch const framed = frame_branch({{{5, -7}}, false}, {});
    EXPECT_EQ(framed.mask.width(), 5);
    EXPECT_EQ(framed.mask.height(), 5);
    EXPECT_EQ((framed.mask[Cell{2, 2}]), 1);
    EXPECT_EQ(framed.mouth, framed.mask.grid().centre({-3, 9}));
}

TEST(Frame, ABranchIsKeptWholeAndItsFrameGivesItselfAgain) {
    ASSERT_TRUE(rc::check("box and at least 5 % around it; the same grid when it is asked for", [] {
        network::Branch branch;
        auto const cells = *rc::gen::inRange(1, 60);
        for (int i = 0; i < cells; ++i) {
            branch.cells.push_back(
                {*rc::gen::inRange<std::int64_t>(-90, 90), *rc::gen::inRange<std::int64_t>(-90, 90)});
        }
        FramedBranch const framed = frame_branch(branch, {});
        Grid const& grid = framed.mask.grid();
        Cell const seed = grid.cell_of(framed.mouth);
        std::int64_t set = 0;
        for (std::uint8_t const v : framed.mask.values()) {
            set += v;
        }
        auto const less = [](Cell a, Cell b) { return a.row != b.row ? a.row < b.row : a.col < b.col; };
        std::sort(branch.cells.begin(), branch.cells.end(), less);
        auto const distinct = std::unique(branch.cells.begin(), branch.cells.end()) - branch.cells.begin();
        RC_ASSERT(set == distinct);
        for (Cell const& c : branch.cells) {
            RC_ASSERT((framed.mask[Cell{c.col + seed.col, c.row + seed.row}]) == 1);
            RC_ASSERT(!grid.on_border({c.col + seed.col, c.row + seed.row}));
        }
        GridRecipe asked;
        asked.width = grid.width;
        asked.height = grid.height;
        asked.origin = {grid.west, grid.north};
        FramedBranch const again = frame_branch(branch, asked);
        RC_ASSERT(again.mask.grid() == grid);
        RC_ASSERT(again.mouth == framed.mouth);
        auto const [low, high] =
            std::minmax_element(branch.cells.begin(), branch.cells.end(), [](Cell a, Cell b) { return a.col < b.col; });
        RC_ASSERT(high->col - low->col + 1 <= room_for_network(grid.width));
    }));
}

TEST(Frame, LinesGetTheirBoxAndAMarginOnWholeCells) {
    RiverLines const lines = one_river({{1005.0, 2003.0, 0.0}, {1995.0, 2503.0, 0.0}});
    GridRecipe wanted;
    wanted.cell_m = 10.0;
    Grid const grid = frame_lines(lines, wanted);
    EXPECT_EQ(grid.west, 950.0);
    EXPECT_GE(grid.east(), 1995.0 + 49.5);
    EXPECT_GE(grid.north, 2503.0 + 49.5);
    EXPECT_LE(grid.south(), 2003.0 - 49.5);
    EXPECT_EQ(grid.crs, "EPSG:32631");
    wanted.width = grid.width;
    wanted.height = grid.height;
    wanted.origin = {grid.west, grid.north};
    EXPECT_EQ(frame_lines(lines, wanted), grid);
}

TEST(Frame, LinesOutsideAreRefusedByNameUnlessClipped) {
    RiverLines const lines = one_river({{1005.0, 2003.0, 0.0}, {1995.0, 2503.0, 0.0}});
    GridRecipe wanted;
    wanted.cell_m = 10.0;
    wanted.width = 20;
    wanted.height = 20;
    EXPECT_TRUE(has(message_of<BadInput>([&] { frame_lines(lines, wanted); }), "river 3 in rivers.gpkg"));
    wanted.clip = true;
    EXPECT_EQ(frame_lines(lines, wanted).width, 20);
    wanted = {};
    wanted.cell_m = 1e-6;
    EXPECT_THROW(frame_lines(lines, wanted), BadInput) << "a billion columns";
    wanted.cell_m = 10.0;
    wanted.origin = {5000.0, 5000.0};
    EXPECT_THROW(frame_lines(lines, wanted), BadInput);
}

} // namespace frame_test
