// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/prepare_lines.hpp>

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <network/rivers.hpp>

#include <thalweg/core/run/error.hpp>

namespace fill_heights_test {

namespace {

using namespace thalweg;
using network::fill_heights;
using test::lines_of;

double const none = std::nan("");

std::vector<double> heights(RiverLines const& lines, std::size_t line) {
    std::vector<double> z;
    for (Vec3 const& v : lines.lines[line].vertices) {
        z.push_back(v.z);
    }
    return z;
}

} // namespace

TEST(FillHeights, NothingToFill) {
    EXPECT_EQ(fill_heights({}, 0.01).filled, 0);
    EXPECT_THROW(fill_heights({}, 0.0), BadParameter);
    auto const all = fill_heights(lines_of({{{0, 0, 5}, {10, 0, 4}}}), 0.01);
    EXPECT_EQ(all.filled, 0);
    auto const no_heights = fill_heights(lines_of({{{0, 0, none}, {10, 0, none}}}), 0.01);
    EXPECT_EQ(no_heights.filled, 0);
    EXPECT_FALSE(no_heights.lines.has_z);
    auto const zeros = fill_heights(lines_of({{{0, 0, 0}, {10, 0, 0}}, {{10, 0, none}, {20, 0, none}}}), 0.01);
    EXPECT_FALSE(zeros.lines.has_z) << "heights that are all 0 are none";
}

TEST(FillHeights, BetweenTwoKnownHeightsLinearByLength) {
    auto const filled = fill_heights(lines_of({{{0, 0, 100}, {100, 0, 90}},
                                               {{100, 0, none}, {130, 0, none}, {200, 0, none}},
                                               {{200, 0, 80}, {300, 0, 70}}}),
                                     0.01);
    EXPECT_EQ(filled.filled, 1);
    EXPECT_EQ(filled.first, 2);
    EXPECT_TRUE(filled.lines.has_z);
    EXPECT_EQ(heights(filled.lines, 1), (std::vector<double>{90, 87, 80}));
    EXPECT_EQ(heights(filled.lines, 0), (std::vector<double>{100, 90}));
}

TEST(FillHeights, FreeEndsRiseUpstreamAndFallDownstream) {
    std::vector<std::vector<Vec3>> const drawn = {{{0, 0, 100}, {100, 0, 90}},
                                                  {{-100, 0, none}, {0, 0, none}},
                                                  {{100, 0, none}, {300, 0, none}},
                                                  {{300, 0, none}, {400, 0, none}}};
    auto const filled = fill_heights(lines_of(drawn), 0.1);
    EXPECT_EQ(filled.filled, 3);
    EXPECT_EQ(heights(filled.lines, 1), (std::vector<double>{110, 100}));
    EXPECT_EQ(heights(filled.lines, 2), (std::vector<double>{90, 70}));
    EXPECT_EQ(heights(filled.lines, 3), (std::vector<double>{70, 60}));

    std::vector<std::vector<Vec3>> upstream = drawn;
    for (auto& line : upstream) {
        line = {line.rbegin(), line.rend()};
    }
    auto const turned = fill_heights(lines_of(upstream), 0.1);
    EXPECT_EQ(heights(turned.lines, 1), (std::vector<double>{100, 110}));
    EXPECT_EQ(heights(turned.lines, 3), (std::vector<double>{60, 70}));
}

TEST(FillHeights, ARiverOfItsOwnBeginsAtTheNearestHeight) {
    auto const filled = fill_heights(lines_of({{{0, 0, 100}, {100, 0, 90}}, {{90, 200, none}, {90, 100, none}}}), 0.1);
    EXPECT_EQ(heights(filled.lines, 1), (std::vector<double>{100, 90}));
}

} // namespace fill_heights_test
