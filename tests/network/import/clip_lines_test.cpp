// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/prepare_lines.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <thalweg/core/vec.hpp>

namespace clip_lines_test {

namespace {

using namespace thalweg;

RiverLines one(std::vector<Vec3> vertices) {
    RiverLines lines;
    lines.lines.push_back({4, std::move(vertices), "", 0});
    lines.has_z = true;
    return lines;
}

Grid const ten{10, 10, 1.0, 0.0, 10.0, ""};

} // namespace

TEST(ClipLines, NothingInside) {
    EXPECT_TRUE(network::clip_lines({}, ten).lines.empty());
    EXPECT_TRUE(network::clip_lines(one({{-5, 5, 1}, {-1, 5, 0}}), ten).lines.empty());
    EXPECT_TRUE(network::clip_lines(one({{-5, 0, 1}, {0, -5, 0}}), ten).lines.empty());
    EXPECT_TRUE(network::clip_lines(one({{0, 5, 1}, {-3, 5, 0}}), ten).lines.empty())
        << "touches the edge in one point";
}

TEST(ClipLines, AllInsideIsKeptBitForBit) {
    RiverLines const lines = one({{0.1, 0.2, 3}, {5, 5, 2}, {10, 10, 1}});
    RiverLines const out = network::clip_lines(lines, ten);
    ASSERT_EQ(out.lines.size(), 1U);
    EXPECT_EQ(out.lines[0].vertices, lines.lines[0].vertices);
}

TEST(ClipLines, LeavesAndReturns) {
    RiverLines const out = network::clip_lines(one({{2, 5, 8}, {12, 5, 6}, {12, 7, 4}, {2, 7, 2}}), ten);
    ASSERT_EQ(out.lines.size(), 2U);
    EXPECT_EQ(out.lines[0].vertices, (std::vector<Vec3>{{2, 5, 8}, {10, 5, 6.4}}));
    EXPECT_EQ(out.lines[1].vertices, (std::vector<Vec3>{{10, 7, 3.6}, {2, 7, 2}}));
    EXPECT_EQ(out.lines[1].feature, 4);
}

TEST(ClipLines, CrossesWithoutAVertexInside) {
    RiverLines const out = network::clip_lines(one({{-10, 5, 30}, {20, 5, 0}}), ten);
    ASSERT_EQ(out.lines.size(), 1U);
    EXPECT_EQ(out.lines[0].vertices, (std::vector<Vec3>{{0, 5, 20}, {10, 5, 10}}));
}

// Law: every metre is inside or beyond.
TEST(ClipLines, WhatLiesBeyondIsSecondary) {
    auto const lines = one({{-10, 5, 30}, {2, 5, 8}, {12, 5, 6}, {12, 7, 4}, {2, 7, 2}, {2, 20, 0}});
    RiverLines const out = network::clip_lines(lines, ten);
    double inside = 0.0;
    double beyond = 0.0;
    for (RiverLine const& line : out.lines) {
        inside += length_in_plan(line.vertices);
    }
    for (SecondaryLine const& line : out.secondary) {
        EXPECT_EQ(line.cause, LeftOut::grid);
        EXPECT_EQ(line.record, line.feature);
        beyond += length_in_plan(line.vertices);
    }
    EXPECT_EQ(out.secondary.size(), 3U);
    EXPECT_NEAR(inside + beyond, length_in_plan(lines.lines.front().vertices), 1e-9);
    EXPECT_TRUE(network::clip_lines(one({{2, 5, 8}, {3, 5, 6}}), ten).secondary.empty());
    EXPECT_EQ(network::clip_lines(one({{-5, 0, 1}, {0, -5, 0}}), ten).secondary.size(), 1U);
}

} // namespace clip_lines_test
