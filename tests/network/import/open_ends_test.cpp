// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/open_ends.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <network/networks.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/geometry/nearby.hpp>

namespace open_ends_test {

using namespace thalweg;

TEST(OpenEnds, GapsAreNarrowerThanTheWayToTheBorder) {
    ASSERT_TRUE(rc::check("a gap leads to another basin, no farther than asked for, and nearer than the border", [] {
        StreamNetwork const net = test::random_forest(*rc::gen::arbitrary<std::uint64_t>(), 30, 6);
        Grid const grid = test::frame(50, 50, 20.0);
        double const most_cells = *rc::gen::inRange(2, 20);
        for (network::GapBelow const& gap : network::gaps_below(net, grid, most_cells)) {
            Vec2 const at = net.node(gap.outlet).at;
            RC_ASSERT(gap.gap_m <= most_cells * grid.cell_m);
            RC_ASSERT(gap.gap_m < std::min({at.x, 1000.0 - at.x, at.y, 1000.0 - at.y}));
            bool is_reached = false;
            for (ArcId a = 0; a < net.arc_count(); ++a) {
                auto const& line = net.arc(a).line;
                for (std::size_t i = 0; i + 1 < line.size(); ++i) {
                    bool const is_there = distance(at, geometry::foot_on(line[i], line[i + 1], at).at) == gap.gap_m;
                    is_reached = is_reached || (is_there && net.basin(net.from(a)) != net.basin(gap.outlet));
                }
            }
            RC_ASSERT(is_reached);
        }
    }));
}

TEST(OpenEnds, RiversEndAroundAHollowUnlessOneRunsBetween) {
    std::vector<Vec2> nodes{{100, 500}, {450, 500}, {500, 900}, {500, 550}, {520, 480}, {900, 200}};
    std::vector<test::Reach> reaches{{0, 1}, {2, 3}, {4, 5}};
    Grid const grid = test::frame(50, 50, 20.0);
    auto found = network::hollows(test::network_of(nodes, reaches), grid);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].source, 4U);
    EXPECT_EQ(found[0].ends, (std::vector<NodeId>{1, 3}));
    EXPECT_DOUBLE_EQ(found[0].farthest_m, std::sqrt(5300.0));
    nodes.insert(nodes.end(), {{480, 600}, {480, 300}}); // in the way of the first
    reaches.push_back({6, 7});
    found = network::hollows(test::network_of(nodes, reaches), grid);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].ends, std::vector<NodeId>{3});
}

TEST(OpenEnds, LakesAreAsFarAsTheirShore) {
    Polygon lake;
    lake.rings.push_back({{0, 0}, {10, 0}, {10, 10}, {0, 10}});
    EXPECT_EQ(network::distance_to_lakes({13, 5}, {lake}), 3.0);
    EXPECT_EQ(network::distance_to_lakes({5, 9}, {lake}), 0.0);
    EXPECT_TRUE(std::isinf(network::distance_to_lakes({5, 9}, {})));
}

} // namespace open_ends_test
