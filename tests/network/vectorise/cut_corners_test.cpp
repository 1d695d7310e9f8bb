// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/vectorise/prune.hpp>

#include <cmath>
#include <cstdlib>
#include <limits>

#include <gtest/gtest.h>
#include <network/networks.hpp>
#include <rapidcheck.h>

#include <thalweg/core/run/error.hpp>

namespace cut_corners_test {

namespace {

using namespace thalweg;
using network::cut_corners;

std::vector<Vec2> first_line(StreamNetwork const& net) {
    return net.arcs().front().line;
}

} // namespace

TEST(CutCorners, RefusesCellsWithoutSize) {
    StreamNetwork const net = test::network_of({{0, 0}, {1, 0}}, {{0, 1}});
    for (double const cell : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_THROW(cut_corners(net, cell), BadParameter);
    }
}

TEST(CutCorners, ACornerGoesAndStraightAndDiagonalStepsStay) {
    StreamNetwork const net =
        test::network_of({{0, 0}, {5, 4}}, {{0, 1, {{1, 0}, {2, 0}, {2, 1}, {3, 2}, {4, 3}, {5, 3}}}});
    std::vector<Vec2> const wanted = {{0, 0}, {1, 0}, {2, 1}, {3, 2}, {4, 3}, {5, 4}};
    EXPECT_EQ(first_line(cut_corners(net, 1.0)), wanted);
}

TEST(CutCorners, OfAStaircaseEverySecondCornerIsLeft) {
    StreamNetwork const net = test::network_of({{0, 0}, {2, 2}}, {{0, 1, {{1, 0}, {1, 1}, {2, 1}}}});
    EXPECT_EQ(first_line(cut_corners(net, 1.0)), (std::vector<Vec2>{{0, 0}, {1, 1}, {2, 2}}));
}

TEST(CutCorners, LinesThatDoNotRunFromCellToCellStay) {
    StreamNetwork const net = test::network_of({{0, 0}, {20, 20}}, {{0, 1, {{20, 0}}}});
    EXPECT_EQ(first_line(cut_corners(net, 1.0)), first_line(net));
}

TEST(CutCorners, PrunedRiversHaveNoCornerAndKeepTheirEnds) {
    ASSERT_TRUE(rc::check("corners", [] {
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1000);
        StreamNetwork const net = network::prune(test::random_skeleton(seed, 48), {3.0, 1.0}).network;
        StreamNetwork const cut = cut_corners(net, 1.0);
        RC_ASSERT(net.from() == cut.from());
        RC_ASSERT(net.to() == cut.to());
        for (std::size_t a = 0; a < cut.arc_count(); ++a) {
            auto const& line = cut.arc(a).line;
            RC_ASSERT(line.front() == net.arc(a).line.front());
            RC_ASSERT(line.back() == net.arc(a).line.back());
            RC_ASSERT(cut.length_m(a) <= net.length_m(a));
            for (std::size_t i = 2; i < line.size(); ++i) {
                RC_ASSERT(distance(line[i - 2], line[i]) > 1.5);
            }
        }
    }));
}

} // namespace cut_corners_test
