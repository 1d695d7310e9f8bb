// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/nearby.hpp>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/geometry/segment_grid.hpp>

namespace nearby_test {

using namespace thalweg;
using geometry::PointGrid;

namespace {

std::size_t nearest_of_all(std::vector<Vec2> const& points, Vec2 p) {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < points.size(); ++i) {
        Vec2 const d = points[i] - p;
        if (dot(d, d) < least) {
            least = dot(d, d);
            best = i;
        }
    }
    return best;
}

} // namespace

TEST(PointGrid, FewCellsForAWideCloud) {
    PointGrid const grid({{0.0, 0.0}, {1e9, 0.0}}, 1e-3);
    EXPECT_EQ(grid.nearest({4e8, 7.0}), 0U);
    EXPECT_EQ(grid.nearest({6e8, 7.0}), 1U);
}

TEST(PointGrid, IsTheNearestOfAll) {
    ASSERT_TRUE(rc::check("as a search of all points, for places inside and outside", [] {
        auto const count = *rc::gen::inRange<std::uint64_t>(1, 80).as("count");
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30).as("seed");
        auto const lattice = *rc::gen::element<std::uint64_t>(5, 1000).as("lattice");
        auto const cell_m = *rc::gen::element(0.3, 2.0, 50.0).as("cell_m");
        auto const draw = [&](std::uint64_t stage, std::uint64_t i) {
            return static_cast<double>(random_word(seed, stage, i) % lattice) * 10.0 / static_cast<double>(lattice);
        };
        std::vector<Vec2> points;
        for (std::uint64_t i = 0; i < count; ++i) {
            points.push_back({draw(1, i), draw(2, i)});
        }
        PointGrid const grid(points, cell_m);
        for (std::uint64_t i = 0; i < 50; ++i) {
            Vec2 const p{3.0 * draw(3, i) - 10.0, 3.0 * draw(4, i) - 10.0};
            RC_ASSERT(grid.nearest(p) == nearest_of_all(points, p));
        }
    }));
}

TEST(SegmentIndex, FindsAllWithinTheMargin) {
    EXPECT_TRUE(geometry::SegmentIndex({}).near({0.0, 0.0}, {1.0, 1.0}, 1e9).empty());
    ASSERT_TRUE(rc::check("as a search of all segments, also of points and far from the origin", [] {
        auto const count = *rc::gen::inRange<std::uint64_t>(1, 80).as("count");
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30).as("seed");
        auto const lattice = *rc::gen::element<std::uint64_t>(5, 1000).as("lattice");
        auto const margin_m = *rc::gen::element(0.0, 0.1, 2.0).as("margin_m");
        auto const origin = *rc::gen::element(Vec2{0.0, 0.0}, Vec2{761899.2, -4036556.2}).as("origin");
        auto const draw = [&](std::uint64_t stage, std::uint64_t i) {
            auto const along = [&](std::uint64_t axis) {
                return static_cast<double>(random_word(seed, 2 * stage + axis, i) % lattice) * 10.0 /
                       static_cast<double>(lattice);
            };
            return origin + Vec2{along(0), along(1)};
        };
        std::vector<std::pair<Vec2, Vec2>> segments;
        for (std::uint64_t i = 0; i < count; ++i) {
            segments.emplace_back(draw(1, i), i % 5 == 0 ? draw(1, i) : draw(2, i));
        }
        geometry::SegmentIndex const index(segments);
        for (std::uint64_t i = 0; i < 50; ++i) {
            geometry::Segment const one{draw(3, i), draw(4, i)};
            std::vector<std::size_t> const near = index.near(one.a, one.b, margin_m);
            RC_ASSERT(std::ranges::adjacent_find(near, std::greater_equal()) == near.end());
            for (std::size_t k = 0; k < segments.size(); ++k) {
                geometry::Segment const other{segments[k].first, segments[k].second};
                bool const is_within = geometry::squared_distance(one, other) <= margin_m * margin_m;
                RC_ASSERT((!is_within || std::ranges::binary_search(near, k)));
            }
        }
    }));
}

} // namespace nearby_test
