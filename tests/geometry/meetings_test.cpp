// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/crossings.hpp>

#include <limits>
#include <set>
#include <tuple>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <thalweg/core/run/error.hpp>

namespace meetings_test {

using thalweg::BadInput;
using thalweg::Vec2;
using thalweg::geometry::EndNodes;
using thalweg::geometry::Meeting;
using thalweg::geometry::meetings;

namespace {

using Lines = std::vector<std::vector<Vec2>>;

std::vector<EndNodes> apart(Lines const& lines) {
    std::vector<EndNodes> nodes;
    for (std::size_t l = 0; l < lines.size(); ++l) {
        nodes.push_back({2 * l, 2 * l + 1});
    }
    return nodes;
}

} // namespace

TEST(Meetings, NothingGivesNothing) {
    EXPECT_TRUE(meetings({}, {}).empty());
    EXPECT_TRUE(meetings({{}, {{1, 1}}}, {{0, 1}, {2, 3}}).empty());
    EXPECT_TRUE(meetings({{{0, 0}, {1, 0}, {2, 1}}}, {{0, 1}}).empty());
}

TEST(Meetings, RefusesWhatDoesNotBelongTogether) {
    EXPECT_THROW(meetings({{{0, 0}, {1, 0}}}, {}), BadInput);
    EXPECT_THROW(meetings({{{0, 0}, {std::numeric_limits<double>::quiet_NaN(), 0}}}, {{0, 1}}), BadInput);
}

TEST(Meetings, ACommonNodeIsNone) {
    Lines const lines{{{0, 2}, {1, 1}}, {{2, 2}, {1, 1}}, {{1, 1}, {1, 0}}};
    EXPECT_TRUE(meetings(lines, {{1, 4}, {2, 4}, {4, 5}}).empty());
    // The second has a node of its own in the same place.
    EXPECT_EQ(meetings(lines, {{1, 4}, {2, 3}, {4, 5}}),
              (std::vector<Meeting>{{0, 1, 0, 0, {1, 1}, {1, 1}}, {1, 2, 0, 0, {1, 1}, {1, 1}}}));
}

TEST(Meetings, ProperCrossing) {
    EXPECT_EQ(meetings({{{0, 0}, {3, 3}}, {{0, 3}, {1, 2}, {3, 0}}}, {{0, 1}, {2, 3}}),
              (std::vector<Meeting>{{0, 1, 0, 1, {1.5, 1.5}, {1.5, 1.5}}}));
}

TEST(Meetings, SharedStretch) {
    EXPECT_EQ(meetings({{{0, 0}, {4, 0}}, {{6, 0}, {2, 0}}}, {{0, 1}, {2, 3}}),
              (std::vector<Meeting>{{0, 1, 0, 0, {2, 0}, {4, 0}}}));
}

TEST(Meetings, AFoldIsOneOfALineWithItself) {
    EXPECT_EQ(meetings({{{0, 0}, {4, 0}, {3, 0}, {3, -1}}}, {{0, 1}}),
              (std::vector<Meeting>{{0, 0, 0, 1, {3, 0}, {4, 0}}, {0, 0, 0, 2, {3, 0}, {3, 0}}}));
}

TEST(Meetings, ARingMeetsItself) {
    Lines const ring{{{0, 0}, {1, 0}, {1, 1}, {0, 0}}};
    EXPECT_EQ(meetings(ring, {{0, 1}}), (std::vector<Meeting>{{0, 0, 0, 2, {0, 0}, {0, 0}}}));
}

TEST(Meetings, AreWhereCrossingsAre) {
    ASSERT_TRUE(rc::check("the places are those of crossings", [] {
        auto const whole = [](int beyond) { return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, beyond)); };
        Lines lines(static_cast<std::size_t>(whole(5)));
        for (auto& line : lines) {
            line.resize(static_cast<std::size_t>(whole(6)));
            for (Vec2& p : line) {
                p = {static_cast<double>(whole(6)), static_cast<double>(whole(6))};
            }
        }
        for (auto& line : lines) {
            line.erase(std::unique(line.begin(), line.end()), line.end());
        }
        using Place = std::tuple<std::size_t, std::size_t, double, double>; // line, segment
        std::set<Place> met;
        for (Meeting const& m : meetings(lines, apart(lines))) {
            for (Vec2 const p : {m.at, m.until}) {
                met.emplace(m.line, m.segment, p.x, p.y);
                met.emplace(m.other, m.other_segment, p.x, p.y);
            }
        }
        std::set<Place> crossed;
        for (auto const& c : thalweg::geometry::crossings(lines)) {
            crossed.emplace(c.line, c.segment, c.at.x, c.at.y);
        }
        RC_ASSERT(met == crossed);
    }));
}

} // namespace meetings_test
