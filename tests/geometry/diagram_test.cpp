// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/diagram.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <stop_token>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/geometry/internal/diagram.hpp>
#include <thalweg/geometry/nearby.hpp>

namespace diagram_test {

using namespace thalweg;
using namespace thalweg::geometry;

namespace {

using Lines = std::vector<LabelledLine>;

Bounds const square{-1.0, -1.0, 9.0, 9.0};

/// Some edges of a lattice whose nodes were moved at random; labels at random. jitter 0: all nodes on circles of four.
Lines lattice(std::uint64_t seed, double jitter, double share, Vec2 corner = {}) {
    RandomStream random(seed, 1, 0);
    constexpr std::size_t side = 8;
    std::vector<Vec2> nodes;
    for (std::size_t i = 0; i < side * side; ++i) {
        double const dx = jitter * (random.real() - 0.5);
        double const dy = jitter * (random.real() - 0.5);
        nodes.push_back({corner.x + static_cast<double>(i % side) + dx, corner.y + static_cast<double>(i / side) + dy});
    }
    Lines lines;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        for (std::size_t const step : {std::size_t{1}, side}) {
            bool const inside = step == 1 ? i % side + 1 < side : i + side < nodes.size();
            if (inside && random.real() < share) {
                lines.push_back({{nodes[i], nodes[i + step]}, static_cast<std::int64_t>(random.real() * 5.0)});
            }
        }
    }
    return lines;
}

enum class Kind { points, segments };

/// Distance from p to each label, looked at one by one.
std::map<std::int64_t, double> distances(Lines const& lines, Vec2 p, Kind kind) {
    std::map<std::int64_t, double> out;
    for (auto const& [line, label] : lines) {
        double& least = out.try_emplace(label, std::numeric_limits<double>::infinity()).first->second;
        for (std::size_t i = 0; i < line.size(); ++i) {
            Vec2 const to = kind == Kind::segments && i + 1 < line.size() ? line[i + 1] : line[i];
            least = std::min(least, distance(p, foot_on(line[i], to, p).at));
        }
    }
    return out;
}

/// The labels of what is nearest.
std::set<std::int64_t> nearest(Lines const& lines, Vec2 p, Kind kind) {
    auto const all = distances(lines, p, kind);
    double least = std::numeric_limits<double>::infinity();
    for (auto const& [label, d] : all) {
        least = std::min(least, d);
    }
    std::set<std::int64_t> out;
    for (auto const& [label, d] : all) {
        if (d <= least * (1.0 + 1e-12)) {
            out.insert(label);
        }
    }
    return out;
}

bool common(std::set<std::int64_t> const& a, std::set<std::int64_t> const& b) {
    return std::ranges::any_of(a, [&](std::int64_t label) { return b.contains(label); });
}

Vec2 between(Vec2 a, Vec2 b, double share) {
    return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)};
}

void check_edges(Diagram const& diagram, Lines const& lines, Bounds const& bounds, Kind kind, double tolerance) {
    for (auto const& edge : diagram.edges) {
        auto const& left = diagram.sites[edge.left];
        auto const& right = diagram.sites[edge.right];
        RC_ASSERT(edge.line.size() >= 2U);
        RC_ASSERT(edge.line.front() == diagram.vertices[edge.from].at);
        RC_ASSERT(edge.line.back() == diagram.vertices[edge.to].at);
        for (Vec2 const p : edge.line) {
            RC_ASSERT(p.x >= bounds.west && p.x <= bounds.east && p.y >= bounds.south && p.y <= bounds.north);
            double const d = distance_to(left, p);
            RC_ASSERT(std::fabs(d - distance_to(right, p)) <= 1e-6 * d + 1e-7);
            for (auto const& [label, other] : distances(lines, p, kind)) {
                RC_ASSERT(other >= d * (1.0 - 1e-6) - 1e-7);
            }
        }
        for (std::size_t i = 0; i + 1 < edge.line.size(); ++i) {
            Vec2 const a = edge.line[i];
            Vec2 const b = edge.line[i + 1];
            Vec2 const middle = between(a, b, 0.5);
            double const length = distance(a, b);
            RC_ASSERT(std::fabs(distance_to(left, middle) - distance_to(right, middle)) <= 2.0 * tolerance + 1e-7);
            if (length < 0.02) {
                continue;
            }
            double const step = (0.01 + 4.0 * tolerance) / length;
            Vec2 const off{-step * (b.y - a.y), step * (b.x - a.x)};
            bool const on_left = distance_to(left, {middle.x + off.x, middle.y + off.y}) <
                                 distance_to(right, {middle.x + off.x, middle.y + off.y});
            bool const on_right = distance_to(right, {middle.x - off.x, middle.y - off.y}) <
                                  distance_to(left, {middle.x - off.x, middle.y - off.y});
            RC_ASSERT(on_left && on_right);
        }
    }
}

void check_vertices(Diagram const& diagram) {
    for (auto const& [at, sites] : diagram.vertices) {
        for (std::size_t const s : sites) {
            double const d = distance_to(diagram.sites[sites.front()], at);
            RC_ASSERT(std::fabs(distance_to(diagram.sites[s], at) - d) <= 1e-6 * d + 1e-7);
        }
    }
}

void check_ends(Diagram const& diagram) {
    std::vector<std::vector<Vec2>> drawn;
    for (auto const& edge : diagram.edges) {
        drawn.push_back(edge.line);
    }
    for (auto const& c : crossings(drawn)) {
        RC_ASSERT(c.at == drawn[c.line].front() || c.at == drawn[c.line].back());
    }
}

/// Where on the way from a to b the nearest is no longer of a label of those nearest to a.
Vec2 change_between(Lines const& lines, Vec2 a, Vec2 b, Kind kind) {
    auto const start = nearest(lines, a, kind);
    double from = 0.0;
    double to = 1.0;
    for (int k = 0; k < 60; ++k) {
        double const middle = 0.5 * (from + to);
        (common(start, nearest(lines, between(a, b, middle), kind)) ? from : to) = middle;
    }
    return between(a, b, from);
}

/// Whether a vertex that lines of several labels share is nearest.
bool touches_shared(Lines const& lines, Vec2 p, Kind kind) {
    double least = std::numeric_limits<double>::infinity();
    for (auto const& [label, d] : distances(lines, p, kind)) {
        least = std::min(least, d);
    }
    std::map<std::pair<double, double>, std::set<std::int64_t>> at;
    for (auto const& [line, label] : lines) {
        for (Vec2 const v : line) {
            at[{v.x, v.y}].insert(label);
        }
    }
    return std::ranges::any_of(at, [&](auto const& vertex) {
        Vec2 const v{vertex.first.first, vertex.first.second};
        return vertex.second.size() > 1 && distance(p, v) <= least * (1.0 + 1e-6);
    });
}

/// Between places whose nearest have no label in common an edge runs.
void check_nothing_is_missing(Diagram const& diagram, Lines const& lines, Kind kind, Vec2 corner, std::uint64_t seed) {
    RandomStream random(seed, 2, 0);
    for (int trial = 0; trial < 60; ++trial) {
        Vec2 const a{corner.x - 0.9 + 9.8 * random.real(), corner.y - 0.9 + 9.8 * random.real()};
        Vec2 const b{a.x + 0.01 * (random.real() - 0.5), a.y + 0.01 * (random.real() - 0.5)};
        if (common(nearest(lines, a, kind), nearest(lines, b, kind))) {
            continue;
        }
        // Longer, for chords stand off their arcs.
        std::vector<std::vector<Vec2>> drawn{{between(a, b, -4.0), between(a, b, 5.0)}};
        for (auto const& edge : diagram.edges) {
            drawn.push_back(edge.line);
        }
        auto const found = crossings(drawn);
        bool const met = std::ranges::any_of(found, [](Crossing const& c) { return c.line == 0; });
        bool const through_shared = touches_shared(lines, change_between(lines, a, b, kind), kind);
        RC_ASSERT(met || through_shared);
    }
}

} // namespace

TEST(Diagram, FewerThanTwoSitesOrLabelsHaveNone) {
    for (Lines const& lines :
         {Lines{}, Lines{{{}, 1}}, Lines{{{{0, 0}}, 1}}, Lines{{{{0, 0}}, 1}, {{{0, 0}}, 2}},
          Lines{{{{0, 0}, {1, 1}}, 1}}, Lines{{{{0, 0}, {1, 1}, {2, 0}}, 7}, {{{4, 4}, {5, 5}}, 7}},
          Lines{{{{0, 0}, {1, 1}}, 1}, {{{0, 0}, {1, 1}}, 2}}}) {
        EXPECT_TRUE(voronoi(lines, square).edges.empty());
        EXPECT_TRUE(medial_lines(lines, square, {0.1}).edges.empty());
    }
}

TEST(Diagram, RefusesWhatCannotBe) {
    Lines const bad{{{{0, 0}, {NAN, 1}}, 1}, {{{2, 2}}, 2}};
    EXPECT_THROW(voronoi(bad, square), BadInput);
    EXPECT_THROW(medial_lines(bad, square, {0.1}), BadInput);
    EXPECT_THROW(voronoi({}, {0, 0, 0, 1}), BadParameter);
    EXPECT_THROW(medial_lines({}, {0, 2, 1, 1}, {0.1}), BadParameter);
    EXPECT_THROW(medial_lines({}, square, {0.0}), BadParameter);
    EXPECT_THROW(medial_lines({{{{0, 0}, {4, 4}}, 1}, {{{0, 4}, {4, 0}}, 2}}, square, {0.1}), BadInput);
    EXPECT_THROW(medial_lines({{{{0, 0}, {4, 0}}, 1}, {{{2, 0}, {2, 4}}, 2}}, square, {0.1}), BadInput);
}

TEST(Diagram, TwoPointsHaveOneLineFromBoundToBound) {
    Lines const lines{{{{2, 4}}, 1}, {{{6, 4}}, 2}};
    for (Diagram const& d : {voronoi(lines, square), medial_lines(lines, square, {0.1})}) {
        ASSERT_EQ(d.edges.size(), 1U);
        auto const& edge = d.edges.front();
        EXPECT_NEAR(distance(edge.line.front(), edge.line.back()), 10.0, 1e-12);
        EXPECT_NEAR(edge.line.front().x, 4.0, 1e-12);
        bool const up = edge.line.back().y > edge.line.front().y;
        EXPECT_EQ(edge.left, up ? 0U : 1U);
    }
}

TEST(Diagram, PointsOnALineHaveParallels) {
    Lines lines;
    for (int i = 0; i < 7; ++i) {
        lines.push_back({{{1.0 * i, 1.0 * i}}, i});
    }
    EXPECT_EQ(voronoi(lines, square).edges.size(), 6U);
    EXPECT_EQ(medial_lines(lines, square, {0.1}).edges.size(), 6U);
}

TEST(Diagram, PointAndSegmentHaveAParabolaBetween) {
    Lines const lines{{{{-50, 0}, {60, 0}}, 1}, {{{4, 2}}, 2}};
    Diagram const d = medial_lines(lines, square, {1e-3});
    ASSERT_EQ(d.edges.size(), 1U);
    EXPECT_GT(d.edges.front().line.size(), 20U);
    EXPECT_LT(d.edges.front().line.size(), 200U);
    for (Vec2 const p : d.edges.front().line) {
        EXPECT_NEAR(p.y, ((p.x - 4.0) * (p.x - 4.0) + 4.0) / 4.0, 1e-3);
    }
}

TEST(Diagram, FourPointsOnACircleShareAVertex) {
    Lines const lines{{{{2, 2}}, 1}, {{{6, 2}}, 2}, {{{6, 6}}, 3}, {{{2, 6}}, 4}};
    for (Diagram const& d : {voronoi(lines, square), medial_lines(lines, square, {0.1})}) {
        ASSERT_EQ(d.edges.size(), 4U);
        std::set<std::size_t> centre;
        for (auto const& edge : d.edges) {
            centre.insert(d.vertices[edge.from].at == Vec2{4, 4} ? edge.from : edge.to);
        }
        ASSERT_EQ(centre.size(), 1U);
        EXPECT_EQ(d.vertices[*centre.begin()].sites, (std::vector<std::size_t>{0, 1, 2, 3}));
    }
}

/// Of the diagram that make(lines, bounds) draws of a lattice at random, anywhere.
void check_laws(Kind kind, double error, auto const& make) {
    auto const seed = *rc::gen::arbitrary<std::uint64_t>();
    double const jitter = *rc::gen::element(0.0, 0.5);
    Vec2 const corner = *rc::gen::element(Vec2{}, Vec2{500000.0, 4500000.0});
    Lines const lines = lattice(seed, jitter, 0.4, corner);
    Bounds const bounds{corner.x - 1, corner.y - 1, corner.x + 9, corner.y + 9};
    Diagram const diagram = make(lines, bounds);
    check_edges(diagram, lines, bounds, kind, error);
    check_vertices(diagram);
    check_ends(diagram);
    check_nothing_is_missing(diagram, lines, kind, corner, seed);
}

TEST(Diagram, VoronoiKeepsItsLaws) {
    ASSERT_TRUE(rc::check([] {
        check_laws(Kind::points, 0.0, [](Lines const& lines, Bounds const& bounds) { return voronoi(lines, bounds); });
    }));
}

TEST(Diagram, MedialLinesKeepTheirLaws) {
    ASSERT_TRUE(rc::check([] {
        check_laws(Kind::segments, 1e-3,
                   [](Lines const& lines, Bounds const& bounds) { return medial_lines(lines, bounds, {1e-3}); });
    }));
}

TEST(Diagram, NeedsNoGuess) {
    using Site = Diagram::Site;
    auto const point = [](Vec2 p) { return Site{0, 0, p, p}; };
    Vec2 const none{NAN, NAN};
    Vec2 const middle = equidistant({point({0, 0}), point({2, 0}), point({0, 2})}, none);
    EXPECT_NEAR(distance(middle, {1, 1}), 0.0, 1e-12);
    // Two stretches of a river that goes almost straight on, and a place beside it: seen from both sides.
    for (double const bend : {1e-3, 1e-6, 1e-9}) {
        Site const before{0, 0, {-100, bend}, {0, 0}};
        Site const after{0, 1, {0, 0}, {150, 1.5 * bend}};
        std::array<Site, 3> const sites{point({7, 30}), before, after};
        Vec2 const p = equidistant(sites, none);
        for (Site const& site : sites) {
            EXPECT_NEAR(distance_to(site, p), 49.0 / 60.0 + 15.0, 1e-6) << bend;
        }
        EXPECT_NEAR(p.x, 0.0, 1e-2) << bend;
    }
}

TEST(Diagram, CanBeStopped) {
    std::stop_source stop;
    stop.request_stop();
    thalweg::Run run;
    run.stop = stop.get_token();
    Lines const lines = lattice(1, 0.5, 0.5);
    EXPECT_THROW(voronoi(lines, square, run), Cancelled);
    EXPECT_THROW(medial_lines(lines, square, {0.1}, run), Cancelled);
}

} // namespace diagram_test
