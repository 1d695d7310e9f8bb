// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/triangulate.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <stop_token>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>
#include <tins.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/geometry/triangles.hpp>

namespace triangulate_test {

using namespace thalweg;
using geometry::triangulate;
using geometry::Triangulation;

namespace {

using test::has;
using test::message_of;

constexpr double none = std::numeric_limits<double>::quiet_NaN();

std::string refusal(std::vector<Vec3> const& points, std::vector<std::vector<Vec3>> const& lines = {}) {
    return message_of<BadInput>([&] { triangulate(points, lines); });
}

/// Triangles by the places of their corners.
std::set<std::set<std::pair<double, double>>> places_of(Tin const& tin) {
    std::set<std::set<std::pair<double, double>>> all;
    for (auto const& t : tin.triangles) {
        std::set<std::pair<double, double>> corners;
        for (std::uint32_t const v : t) {
            corners.emplace(tin.vertices[v].x, tin.vertices[v].y);
        }
        all.insert(corners);
    }
    return all;
}

double area_of(Tin const& tin) {
    double area = 0.0;
    for (auto const& t : tin.triangles) {
        area += 0.5 * test::area2(tin.vertices[t[0]], tin.vertices[t[1]], tin.vertices[t[2]]);
    }
    return area;
}

/// Whether p, with whole coordinates, lies strictly within the circle through a triangle.
bool within_circle(Tin const& tin, std::array<std::uint32_t, 3> const& t, Vec3 const& p) {
    std::array<std::array<std::int64_t, 3>, 3> m{};
    for (std::size_t k = 0; k < 3; ++k) {
        auto const dx = static_cast<std::int64_t>(tin.vertices[t[k]].x - p.x);
        auto const dy = static_cast<std::int64_t>(tin.vertices[t[k]].y - p.y);
        m[k] = {dx, dy, dx * dx + dy * dy};
    }
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
               m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]) >
           0;
}

} // namespace

TEST(Triangulate, TooLittleIsRefusedInNumbers) {
    EXPECT_TRUE(has(refusal({}), "0 points in 0 different places"));
    EXPECT_TRUE(has(refusal({{0, 0, 1}, {1, 1, 1}}), "2 points in 2 different places"));
    EXPECT_TRUE(has(refusal({{0, 0, 1}, {1, 1, 1}, {0, 0, 5}}), "3 points in 2 different places"));
    EXPECT_TRUE(has(refusal({{0, 0, 1}, {3, 3, 1}, {1, 1, 1}}), "3 points lie on one line, from (0, 0) to (3, 3)"));
    EXPECT_TRUE(has(refusal({}, {{{0, 0, 1}, {1, 0, 1}}, {{2, 0, 1}, {3, 0, 1}}}), "4 points lie on one line"));
    EXPECT_TRUE(has(refusal({}, {{}, {}}), "0 points"));
}

TEST(Triangulate, WhatIsNotFiniteIsNamed) {
    EXPECT_TRUE(has(refusal({{0, 0, 1}, {1, 0, none}}), "point 2 is not finite"));
    EXPECT_TRUE(has(refusal({{0, 0, 1}, {none, 0, 0}}), "point 2 is not finite"));
    EXPECT_TRUE(has(refusal({}, {{{0, 0, 0}, {1, -INFINITY, 0}}}), "vertex 2 of breakline 1 is not finite"));
    EXPECT_TRUE(has(refusal({{0, 2e15, 1}}), "farther than"));
}

TEST(Triangulate, Square) {
    Triangulation const t = triangulate({{0, 0, 1}, {1, 0, 2}, {0, 1, 3}, {1, 1, 4}});
    ASSERT_EQ(t.tin.triangles.size(), 2U);
    EXPECT_TRUE(test::is_lawful(t.tin));
    EXPECT_EQ(t.vertex_of_point, (std::vector<std::uint32_t>{0, 1, 2, 3}));
}

TEST(Triangulate, OfPointsAtOnePlaceTheFirstStands) {
    Triangulation const t =
        triangulate({{0, 0, 1}, {4, 0, 2}, {0, 0, 9}, {0, 4, 3}, {-0.0, 0, 4}}, {{{4, 0, 2}, {0, 4, 2.5}}});
    EXPECT_EQ(t.tin.vertices, (std::vector<Vec3>{{0, 0, 1}, {4, 0, 2}, {0, 4, 3}}));
    EXPECT_EQ(t.vertex_of_point, (std::vector<std::uint32_t>{0, 1, 0, 2, 0}));
    EXPECT_EQ(t.merged, 4);
    EXPECT_EQ(t.merged_dz_m, 8.0);
    EXPECT_EQ(t.chains, (std::vector<std::vector<std::uint32_t>>{{1, 2}}));
}

TEST(Triangulate, CrossingTakesTheHeightOfTheFirstLine) {
    Triangulation const t = triangulate({}, {{{0, 0, 0}, {4, 4, 8}}, {{0, 4, 100}, {4, 0, 120}}});
    ASSERT_EQ(t.tin.vertices.size(), 5U);
    EXPECT_EQ(t.tin.vertices[4], (Vec3{2, 2, 4}));
    EXPECT_EQ(t.crossings, 1);
    EXPECT_EQ(t.crossings_dz_m, 106.0);
    EXPECT_EQ(t.tin.triangles.size(), 4U);
    EXPECT_EQ(t.chains, (std::vector<std::vector<std::uint32_t>>{{0, 4, 1}, {2, 4, 3}}));
}

TEST(Triangulate, LineThroughAPointTakesItsHeight) {
    Triangulation const t =
        triangulate({{2, 0, 7}, {1, 3, 0}, {1, -3, 0}}, {{{0, 0, 0}, {4, 0, 0}}, {{3, 0, 5}, {3, 2, 1}}});
    EXPECT_EQ(t.crossings, 0);
    EXPECT_EQ(t.chains[0], (std::vector<std::uint32_t>{3, 0, 5, 4}));
    EXPECT_EQ(t.tin.vertices[0].z, 7.0);
    EXPECT_EQ(t.tin.vertices[5].z, 5.0);
}

// Law: no vertex lies strictly within a triangle's circle; the triangles fill the hull.
TEST(Triangulate, IsDelaunayInAnyOrderOfTheInput) {
    ASSERT_TRUE(rc::check([] {
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30);
        auto const count = *rc::gen::inRange<std::size_t>(3, 60);
        auto points = test::random_points(count, 8.0, seed, 8);
        points.push_back({0, 0, 1});
        points.push_back({8, 0, 1});
        points.push_back({8, 8, 1});
        points.push_back({0, 8, 1});
        Triangulation const t = triangulate(points);
        RC_ASSERT(test::is_lawful(t.tin));
        RC_ASSERT(area_of(t.tin) == 64.0);
        for (auto const& triangle : t.tin.triangles) {
            for (Vec3 const& v : t.tin.vertices) {
                RC_ASSERT(!within_circle(t.tin, triangle, v));
            }
        }
        for (std::size_t i = 0; i < points.size(); ++i) {
            Vec3 const v = t.tin.vertices[t.vertex_of_point[i]];
            RC_ASSERT((v.x == points[i].x && v.y == points[i].y));
        }
        std::reverse(points.begin(), points.end());
        std::rotate(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(points.size() / 3), points.end());
        RC_ASSERT(places_of(triangulate(points).tin) == places_of(t.tin));
        RC_ASSERT(places_of(triangulate(points, {{points[0]}}).tin) == places_of(t.tin)); // the constrained kind
    }));
}

// Law: every segment of a breakline is a chain of edges.
TEST(Triangulate, BreaklinesAreEdges) {
    ASSERT_TRUE(rc::check([] {
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30);
        int const steps = *rc::gen::element(0, 12);
        auto const points = test::random_points(30, 12.0, seed, steps);
        std::vector<std::vector<Vec3>> lines;
        for (std::uint64_t l = 0; l < 5; ++l) {
            lines.push_back(test::random_points(4, 12.0, seed + l + 1, steps));
        }
        Triangulation const t = triangulate(points, lines);
        RC_ASSERT(test::is_lawful(t.tin));
        auto const sides = test::sides_of(t.tin);
        RC_ASSERT(t.chains.size() == lines.size());
        for (std::size_t l = 0; l < lines.size(); ++l) {
            auto const& chain = t.chains[l];
            auto const same = [&](std::uint32_t v, Vec3 const& p) {
                return t.tin.vertices[v].x == p.x && t.tin.vertices[v].y == p.y;
            };
            std::size_t at = 0;
            for (Vec3 const& p : lines[l]) {
                while (at < chain.size() && !same(chain[at], p)) {
                    ++at;
                }
                RC_ASSERT(at < chain.size());
            }
            for (std::size_t i = 1; i < chain.size(); ++i) {
                RC_ASSERT(sides.count(std::minmax(chain[i - 1], chain[i])) == 1U);
            }
        }
    }));
}

TEST(Triangulate, StopsWhenAsked) {
    std::stop_source stop;
    stop.request_stop();
    thalweg::Run run;
    run.stop = stop.get_token();
    EXPECT_THROW(triangulate(test::random_points(10, 1.0, 1), {}, run), Cancelled);
}

TEST(SideOfLine, IsExact) {
    using geometry::side_of_line;
    EXPECT_EQ(side_of_line({0, 0}, {2, 0}, {1, 1}), 1);
    EXPECT_EQ(side_of_line({0, 0}, {2, 0}, {1, -1}), -1);
    EXPECT_EQ(side_of_line({0.1, 0.1}, {0.2, 0.2}, {0.3, 0.3}), 0);
    double const next = std::nextafter(0.5, 1.0);
    EXPECT_EQ(side_of_line({12, 12}, {24, 24}, {0.5, next}), 1);
    EXPECT_EQ(side_of_line({12, 12}, {24, 24}, {next, 0.5}), -1);
    EXPECT_EQ(side_of_line({12, 12}, {24, 24}, {next, next}), 0);
    EXPECT_EQ(side_of_line({1e-300, 0}, {0, 1e-300}, {0, 0}), 1);
    EXPECT_EQ(side_of_line({1e200, 0}, {0, 1e200}, {0, 0}), 1);
    EXPECT_EQ(side_of_line({134217729.0, 134217728.0}, {134217730.0, 134217729.0}, {1, 0}), 0);
    EXPECT_EQ(side_of_line({134217729.5, 134217728.5}, {402653190.5, 402653189.5}, {0x1p-26, 0}), 1);
}

TEST(HeightOnPlane, IsExactInSlivers) {
    using geometry::height_on_plane;
    EXPECT_EQ(height_on_plane({0, 0, 1}, {4, 0, 5}, {0, 4, 9}, {1, 1}), 4.0);
    double const least = 0x1p-52;
    // A hair off the line from (0, 0) to (2, 2): all of the way across it lies within the last bit.
    EXPECT_EQ(height_on_plane({0, 0, 0}, {2, 2, 0}, {1, 1 + least, 8}, {1, 1}), 0.0);
    EXPECT_EQ(height_on_plane({0, 0, 0}, {2, 2, 0}, {1, 1 + 2 * least, 8}, {1, 1 + least}), 4.0);
}

} // namespace triangulate_test
