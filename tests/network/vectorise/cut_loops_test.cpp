// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/prepare_lines.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/geometry/crossings.hpp>

namespace cut_loops_test {

using namespace thalweg;
using network::cut_loops;
using network::CutLine;
using Line = std::vector<Vec3>;

TEST(CutLoops, NothingToCut) {
    EXPECT_TRUE(cut_loops({}).line.empty());
    EXPECT_EQ(cut_loops({{1, 2, 3}}).line, (Line{{1, 2, 3}}));
    Line const bend{{0, 0, 3}, {1, 0, 2}, {1, 1, 1}};
    EXPECT_EQ(cut_loops(bend).line, bend);
    EXPECT_EQ(cut_loops(bend).cut_m, 0.0);
}

TEST(CutLoops, RepeatedVerticesGo) {
    EXPECT_EQ(cut_loops({{0, 0, 2}, {0, 0, 2}, {1, 0, 1}}).line, (Line{{0, 0, 2}, {1, 0, 1}}));
}

TEST(CutLoops, RefusesWhatIsNotFinite) {
    EXPECT_THROW(cut_loops({{0, 0, 0}, {std::numeric_limits<double>::infinity(), 0, 0}, {1, 1, 0}}), BadInput);
}

TEST(CutLoops, ACrossingBecomesAVertex) {
    CutLine const cut = cut_loops({{0, 0, 5}, {4, 0, 4}, {4, 2, 3}, {2, 2, 2}, {2, -2, 1}});
    EXPECT_EQ(cut.line, (Line{{0, 0, 5}, {2, 0, 4.5}, {2, -2, 1}}));
    EXPECT_EQ(cut.cut_m, 8.0);
}

TEST(CutLoops, SpikesGo) {
    EXPECT_EQ(cut_loops({{0, 0, 2}, {1, 0, 2}, {1, 1, 2}, {1, 0, 2}, {2, 0, 1}}).line,
              (Line{{0, 0, 2}, {1, 0, 2}, {2, 0, 1}}));
    // Back along itself: it goes on from where it turned.
    EXPECT_EQ(cut_loops({{0, 0, 2}, {2, 0, 2}, {1, 0, 2}, {1, 1, 1}}).line, (Line{{0, 0, 2}, {1, 0, 2}, {1, 1, 1}}));
    // Nearly.
    Line const nearly{{0, 0, 2}, {1, 0, 2}, {1, 1, 2}, {1.001, 0, 2}, {2, 0, 1}};
    EXPECT_EQ(cut_loops(nearly).line, nearly);
    EXPECT_EQ(cut_loops(nearly, 0.01).line, (Line{{0, 0, 2}, {1, 0, 2}, {1.001, 0, 2}, {2, 0, 1}}));
}

TEST(CutLoops, ARingIsAPoint) {
    EXPECT_EQ(cut_loops({{0, 0, 2}, {1, 0, 2}, {1, 1, 2}, {0, 0, 1}}).line.size(), 1U);
}

TEST(CutLoops, AnyLineBecomesSimple) {
    ASSERT_TRUE(rc::check("ends stay, nothing meets itself, nothing is added", [] {
        auto const whole = [](int beyond) { return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, beyond)); };
        Line line(static_cast<std::size_t>(2 + whole(9)));
        for (Vec3& p : line) {
            p = {static_cast<double>(whole(7)), static_cast<double>(whole(7)), static_cast<double>(whole(3))};
        }
        CutLine const cut = cut_loops(line);
        std::vector<Vec2> plan;
        for (Vec3 const p : cut.line) {
            plan.push_back({p.x, p.y});
        }
        RC_ASSERT(geometry::crossings({plan}).empty());
        RC_ASSERT(plan.front() == (Vec2{line.front().x, line.front().y}));
        RC_ASSERT(plan.back() == (Vec2{line.back().x, line.back().y}));
        RC_ASSERT(cut.cut_m >= 0.0);
    }));
}

} // namespace cut_loops_test
