// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/river_claims.hpp>

#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/catchments.hpp>

namespace reaches_of_file_test {

using namespace thalweg;
using make::FileReaches;
using make::reaches_of_file;

namespace {

Grid const grid{10, 10, 1.0, 0.0, 10.0, ""};

NetworkFile::FileArc arc(std::int64_t id, std::int64_t from, std::int64_t to, std::int64_t ds, std::vector<Vec3> line) {
    NetworkFile::FileArc made;
    made.id = id;
    made.from_node = from;
    made.to_node = to;
    made.ds_arc = ds;
    made.line = std::move(line);
    return made;
}

/// Two sources join and leave to the south.
NetworkFile three_arcs() {
    NetworkFile file;
    file.says.basin = false;
    file.arcs = {arc(30, 1, 3, 50, {{2, 8, 0}, {5, 5, 0}}), arc(40, 2, 3, 50, {{8, 8, 0}, {5, 5, 0}}),
                 arc(50, 3, 4, 0, {{5, 5, 0}, {5, 1, 0}})};
    return file;
}

auto refused(NetworkFile const& file, std::string const& words) {
    return test::refused(
        "make.reaches_of_file", [&] { reaches_of_file(file, grid); }, words);
}

std::vector<std::int64_t> downstream(FileReaches const& reaches) {
    std::vector<std::int64_t> ds;
    for (flow::Reach const& reach : reaches.reaches) {
        ds.push_back(reach.ds);
    }
    return ds;
}

} // namespace

TEST(ReachesOfFile, LinksAreThoseOfTheFile) {
    FileReaches const made = reaches_of_file(three_arcs(), grid);
    EXPECT_EQ(downstream(made), (std::vector<std::int64_t>{2, 2, -1}));
    EXPECT_EQ(made.reaches[1].id, 40);
    EXPECT_EQ(made.reaches[1].lines, (std::vector<std::vector<Vec2>>{{{8, 8}, {5, 5}}}));
    EXPECT_EQ(made.basins, (std::vector<std::int64_t>{1, 1, 1}));
    EXPECT_EQ(made.cut, 0);
    EXPECT_EQ(made.outside, 0);
}

TEST(ReachesOfFile, BasinsAreTheFilesOrThoseOfOutlets) {
    NetworkFile file = three_arcs();
    file.arcs[0].ds_arc = 99; // which the file does not hold
    file.arcs[0].to_node = 9;
    EXPECT_EQ(downstream(reaches_of_file(file, grid)), (std::vector<std::int64_t>{-1, 2, -1}));
    EXPECT_EQ(reaches_of_file(file, grid).basins, (std::vector<std::int64_t>{1, 2, 2}));
    file.arcs[0].to_node = 4; // two rivers into one sea
    EXPECT_EQ(reaches_of_file(file, grid).basins, (std::vector<std::int64_t>{1, 1, 1}));
    file.says.basin = true;
    for (auto& a : file.arcs) {
        a.basin = a.id;
    }
    EXPECT_EQ(reaches_of_file(file, grid).basins, (std::vector<std::int64_t>{30, 40, 50}));
}

TEST(ReachesOfFile, PartsOfOneArcAreOneReach) {
    NetworkFile file = three_arcs();
    file.arcs.push_back(arc(40, 7, 8, 50, {{9, 9, 0}, {8, 9, 0}}));
    FileReaches const made = reaches_of_file(file, grid);
    ASSERT_EQ(made.reaches.size(), 3U);
    EXPECT_EQ(made.reaches[1].lines.size(), 2U);
    file.arcs.back().ds_arc = 30;
    EXPECT_TRUE(refused(file, "arcs of the id 40 run into several"));
}

TEST(ReachesOfFile, WhatLeavesTheGridIsCut) {
    NetworkFile file = three_arcs();
    file.arcs[0].line = {{-4, 8, 0}, {4, 8, 0}, {4, 14, 0}, {6, 14, 0}, {6, 6, 0}};
    file.arcs[1].line = {{20, 20, 0}, {15, 15, 0}};
    FileReaches const made = reaches_of_file(file, grid);
    EXPECT_EQ(made.cut, 1);
    EXPECT_EQ(made.outside, 1);
    EXPECT_EQ(made.reaches[0].lines, (std::vector<std::vector<Vec2>>{{{0, 8}, {4, 8}, {4, 10}}, {{6, 10}, {6, 6}}}));
    EXPECT_TRUE(made.reaches[1].lines.empty());
    for (auto& a : file.arcs) {
        a.line = {{20, 20, 0}, {15, 15, 0}};
    }
    EXPECT_TRUE(refused(file, "none of 3 arcs lies on the DEM"));
    EXPECT_TRUE(refused({}, "none of 0 arcs"));
}

TEST(ReachesOfFile, RefusesCirclesAndLeavesOutWhatIsNowhere) {
    NetworkFile file = three_arcs();
    file.arcs[2].ds_arc = 30;
    EXPECT_TRUE(refused(file, "leads to no outlet"));
    file = three_arcs();
    file.arcs[1].line[0].y = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(reaches_of_file(file, grid).outside, 1);
    EXPECT_EQ(reaches_of_file(file, grid).nowhere, 1);
    file = three_arcs();
    file.arcs[1].line.clear();
    EXPECT_EQ(reaches_of_file(file, grid).outside, 1);
    EXPECT_EQ(reaches_of_file(file, grid).nowhere, 0);
}

TEST(StillCells, LieUnderLevelPartsOnTheGrid) {
    NetworkFile file = three_arcs();
    file.arcs[0].line[0].z = 1.0;  // falls
    file.arcs[1].line[0].x = 10.5; // begins off the grid
    Mask const still = make::still_cells(file, grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        Cell const c = grid.at(i);
        EXPECT_EQ(still[i] != 0, c.col == 5 && c.row >= 5 && c.row <= 9) << c.col << " " << c.row;
    }
    file.says.heights = false;
    EXPECT_EQ(make::still_cells(file, grid).cells(), 0);
}

} // namespace reaches_of_file_test
