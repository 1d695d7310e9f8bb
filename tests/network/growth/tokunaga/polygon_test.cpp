// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/tokunaga/internal/embed_tree.hpp>

#include <algorithm>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace polygon_test {

using namespace thalweg;

namespace {

/// Columns of squares side by side, each of its height: all about them can be counted.
std::vector<Vec2> steps(std::vector<int> const& heights) {
    std::vector<Vec2> ring{{0, 0}, {static_cast<double>(heights.size()), 0}};
    for (std::size_t i = heights.size(); i-- > 0;) {
        ring.push_back({static_cast<double>(i + 1), static_cast<double>(heights[i])});
        ring.push_back({static_cast<double>(i), static_cast<double>(heights[i])});
    }
    return ring;
}

} // namespace

TEST(Polygon, NoAreaInALine) {
    EXPECT_EQ(network::area_of({}), 0.0);
    EXPECT_EQ(network::area_of({{1, 1}, {2, 2}}), 0.0);
    EXPECT_EQ(network::area_of({{1, 1}, {2, 2}, {3, 3}}), 0.0);
    EXPECT_TRUE(network::lattice_in({{1, 1}, {2, 2}, {3, 3}}, 0.1).empty());
}

TEST(Polygon, OfATriangle) {
    std::vector<Vec2> const ring{{1e6, 5e6}, {1e6 + 6, 5e6}, {1e6, 5e6 + 3}};
    EXPECT_EQ(network::area_of(ring), 9.0);
    EXPECT_EQ(network::area_of({ring[2], ring[1], ring[0]}), 9.0);
    EXPECT_EQ(network::centroid_of(ring), (Vec2{1e6 + 2, 5e6 + 1}));
    auto const sides = network::sides_of(ring);
    ASSERT_EQ(sides.size(), 3U);
    EXPECT_EQ(sides[2].a, ring[2]);
    EXPECT_EQ(sides[2].b, ring[0]);
}

TEST(Polygon, OfStepsAgainstTheirColumns) {
    ASSERT_TRUE(rc::check("area, centre, inside and lattice of columns", [] {
        auto const heights = *rc::gen::nonEmpty(rc::gen::container<std::vector<int>>(rc::gen::inRange(1, 9)));
        auto ring = steps(heights);
        double area = 0.0;
        double x = 0.0;
        double y = 0.0;
        std::size_t inside = 0;
        for (std::size_t i = 0; i < heights.size(); ++i) {
            double const h = heights[i];
            area += h;
            x += h * (static_cast<double>(i) + 0.5);
            y += h * 0.5 * h;
            for (int row = 0; row < 10; ++row) {
                bool const in = row < heights[i];
                RC_ASSERT(network::contains(ring, {static_cast<double>(i) + 0.3, row + 0.6}) == in);
                inside += in ? 4U : 0U;
            }
        }
        if (*rc::gen::arbitrary<bool>()) {
            std::reverse(ring.begin(), ring.end());
        }
        RC_ASSERT(network::area_of(ring) == area);
        Vec2 const centre = network::centroid_of(ring);
        RC_ASSERT(distance(centre, {x / area, y / area}) < 1e-9);
        auto const places = network::lattice_in(ring, 0.5); // four to each square
        RC_ASSERT(places.size() == inside);
        for (std::size_t k = 0; k < places.size(); ++k) {
            RC_ASSERT(network::contains(ring, places[k]));
            RC_ASSERT((k == 0 || places[k - 1].y < places[k].y ||
                       (places[k - 1].y == places[k].y && places[k - 1].x < places[k].x)));
        }
    }));
}

} // namespace polygon_test
