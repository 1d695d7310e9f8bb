// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/planform/internal/segment_grid.hpp>

#include <set>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace segment_grid_test {

using namespace thalweg;
using network::Segment;
using network::squared_distance;

namespace {

Segment any_segment() {
    auto const any = [] { return 0.5 * *rc::gen::inRange(-10, 50); };
    return {{any(), any()}, {any(), any()}};
}

/// The least distance of places on both, found by steps: never below the true one, and above by a step at most.
double by_steps(Segment const& s, Segment const& t, int steps) {
    double least = 1e300;
    for (int i = 0; i <= steps; ++i) {
        double const f = static_cast<double>(i) / steps;
        Vec2 const p{s.a.x + f * (s.b.x - s.a.x), s.a.y + f * (s.b.y - s.a.y)};
        for (int k = 0; k <= steps; ++k) {
            double const g = static_cast<double>(k) / steps;
            least = std::min(least, distance(p, {t.a.x + g * (t.b.x - t.a.x), t.a.y + g * (t.b.y - t.a.y)}));
        }
    }
    return least;
}

} // namespace

TEST(SegmentGrid, DistanceAgainstSteps) {
    ASSERT_TRUE(rc::check("distance of segments", [] {
        Segment const s = any_segment();
        Segment const t = any_segment();
        double const found = std::sqrt(squared_distance(s, t));
        double const slow = by_steps(s, t, 60);
        RC_ASSERT(found <= slow + 1e-9);
        RC_ASSERT(found >= slow - (distance(s.a, s.b) + distance(t.a, t.b)) / 60.0);
        RC_ASSERT(squared_distance(t, s) == found * found ||
                  std::fabs(std::sqrt(squared_distance(t, s)) - found) < 1e-9);
    }));
}

TEST(SegmentGrid, FindsAllThatAreNear) {
    ASSERT_TRUE(rc::check("near visits each within the margin once, and none that was taken out", [] {
        auto const count = static_cast<std::size_t>(*rc::gen::inRange(1, 30));
        network::SegmentGrid grid({0, 0}, {20, 20}, 0.25 * *rc::gen::inRange(1, 60), count); // some lie outside
        std::vector<Segment> all(count);
        std::vector<bool> held(count, false);
        for (int step = 0; step < 60; ++step) {
            auto const i = static_cast<std::size_t>(*rc::gen::inRange(0, static_cast<int>(count)));
            if (held[i]) {
                grid.remove(i);
            } else {
                all[i] = any_segment();
                grid.add(i, all[i]);
            }
            held[i] = !held[i];
            RC_ASSERT(grid.holds(i) == held[i]);
        }
        Segment const s = any_segment();
        double const margin = 0.5 * *rc::gen::inRange(0, 20);
        std::multiset<std::size_t> seen;
        RC_ASSERT(grid.near(s, margin, [&](std::size_t i) {
            seen.insert(i);
            return true;
        }));
        for (std::size_t i = 0; i < count; ++i) {
            bool const must = held[i] && squared_distance(s, all[i]) <= margin * margin;
            RC_ASSERT(seen.count(i) <= (held[i] ? 1U : 0U));
            RC_ASSERT((!must || seen.count(i) == 1U));
        }
        if (!seen.empty()) {
            int visits = 0;
            RC_ASSERT(!grid.near(s, margin, [&](std::size_t) { return ++visits < 1; }));
            RC_ASSERT(visits == 1);
        }
    }));
}

} // namespace segment_grid_test
