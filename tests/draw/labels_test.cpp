// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/internal/labels.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <thalweg/draw/internal/water.hpp>

#include "small_land.hpp"

namespace labels_test {

using namespace thalweg;
using draw::Label;
using draw::Labels;
using draw::Slab;

namespace {

/// A position of one in a thousand in [low, high].
rc::Gen<double> between(double low, double high) {
    return rc::gen::map(rc::gen::inRange(0, 1001), [=](int k) { return low + (high - low) * k / 1000.0; });
}

Slab slab_of(double x, double y, double turn, double half_length, double half_height) {
    return {{x, y}, {std::cos(turn), std::sin(turn)}, half_length, half_height};
}

Slab any_slab() {
    return slab_of(*between(0.0, 40.0), *between(0.0, 40.0), *between(0.0, 6.3), *between(1.0, 20.0),
                   *between(1.0, 6.0));
}

bool holds(Slab const& slab, Vec2 p) {
    Vec2 const off = p - slab.centre;
    return std::fabs(dot(off, slab.along)) <= slab.half_length + 1e-9 &&
           std::fabs(dot(off, {-slab.along.y, slab.along.x})) <= slab.half_height + 1e-9;
}

/// Whether a point of a fine lattice on one slab lies in the other.
bool meet_somewhere(Slab const& a, Slab const& b) {
    constexpr int parts = 60;
    auto const corners = a.corners();
    for (int i = 0; i <= parts; ++i) {
        for (int k = 0; k <= parts; ++k) {
            if (holds(b,
                      corners[0] + (i / 60.0) * (corners[1] - corners[0]) + (k / 60.0) * (corners[3] - corners[0]))) {
                return true;
            }
        }
    }
    return false;
}

Slab grown(Slab slab, double by) {
    slab.half_length += by;
    slab.half_height += by;
    return slab;
}

std::vector<Vec2> circle(Vec2 centre, double radius) {
    std::vector<Vec2> line;
    for (int k = 0; k <= 120; ++k) {
        double const turn = 2.0 * std::numbers::pi * k / 120.0;
        line.push_back(centre + radius * Vec2{std::cos(turn), std::sin(turn)});
    }
    return line;
}

constexpr double side_m = 4000.0;

/// Cones of 1:4 with their contours, and spot heights at their tops and anywhere.
struct Cones {
    Raster<float> dem{Grid{100, 100, 40.0, 0.0, side_m, ""}};
    Raster<std::uint8_t> hillshade;
    std::vector<std::pair<double, std::vector<Vec2>>> contours;
    std::vector<draw::SpotHeight> spots;
};

Cones any_cones() {
    Cones cones;
    for (int const number : {0, 1, 2}) {
        Vec2 const top{*between(0.0, side_m), *between(0.0, side_m)};
        cones.spots.push_back({top, 500.0});
        for (double z = 10.0 * number; z < 500.0; z += 50.0) {
            cones.contours.emplace_back(z, circle(top, 4.0 * (500.0 - z)));
        }
    }
    for (std::int64_t i = 0; i < cones.dem.cells(); ++i) {
        double nearest = side_m;
        for (draw::SpotHeight const& spot : cones.spots) {
            nearest = std::min(nearest, distance(spot.at, cones.dem.grid().centre(cones.dem.grid().at(i))));
        }
        cones.dem[i] = static_cast<float>(500.0 - nearest / 4.0);
    }
    int const more = *rc::gen::inRange(0, 40);
    for (int k = 0; k < more; ++k) {
        cones.spots.push_back({{*between(0.0, side_m), *between(0.0, side_m)}, *between(0.0, 2000.0)});
    }
    cones.hillshade = test::shade(cones.dem);
    return cones;
}

struct Placed {
    Labels labels;
    draw::Window window{{20.0, 30.0, 900.0, 900.0}, 0.0, side_m, 900.0 / side_m};
};

Placed placed_on(Cones const& cones) {
    Placed out;
    draw::MapSheet sheet{cones.dem, cones.hillshade, nullptr, nullptr, cones.contours};
    sheet.spot_heights = cones.spots;
    draw::paint(10.0, 10.0, draw::Format::png, [&](draw::Cairo* canvas) {
        out.labels = draw::place_labels(canvas, sheet, out.window, draw::lines_on_sheet(sheet, out.window), 20.0, 1.0);
    });
    return out;
}

} // namespace

RC_GTEST_PROP(Slabs, OverlapWhereTheyHaveAPointInCommon, ()) {
    Slab const a = any_slab();
    Slab const b = any_slab();
    RC_ASSERT(draw::overlap(a, b) == draw::overlap(b, a));
    RC_ASSERT(draw::overlap(a, a));
    if (meet_somewhere(a, b)) {
        RC_ASSERT(draw::overlap(a, b));
    } else {
        RC_ASSERT(!draw::overlap(grown(a, -0.6), b)); // the lattice's step is below 0.7
    }
}

RC_GTEST_PROP(Labels, NoneOverlapsAnotherOrTheFrameOrIsUpsideDown, ()) {
    Placed const placed = placed_on(any_cones());
    std::vector<Slab> rooms = placed.labels.marks;
    for (auto const* const list : {&placed.labels.heights, &placed.labels.contours}) {
        for (Label const& label : *list) {
            rooms.push_back(label.room);
            RC_ASSERT(label.room.along.x >= 0.0);
        }
    }
    draw::Box const& frame = placed.window.frame;
    for (std::size_t i = 0; i < rooms.size(); ++i) {
        for (Vec2 const corner : rooms[i].corners()) {
            RC_ASSERT(corner.x >= frame.x && corner.x <= frame.right());
            RC_ASSERT(corner.y >= frame.y && corner.y <= frame.bottom());
        }
        for (std::size_t k = 0; k < i; ++k) {
            RC_ASSERT(!draw::overlap(rooms[i], rooms[k]));
        }
    }
    RC_ASSERT(placed.labels.heights.size() == placed.labels.marks.size());
}

TEST(Labels, ASummitAndIndexContoursHaveTheirHeights) {
    Cones cones;
    Vec2 const top{2000.0, 2000.0};
    cones.spots = {{top, 499.6}, {top, 1.0}};
    for (std::int64_t i = 0; i < cones.dem.cells(); ++i) {
        cones.dem[i] = static_cast<float>(500.0 - distance(top, cones.dem.grid().centre(cones.dem.grid().at(i))) / 4.0);
    }
    cones.hillshade = test::shade(cones.dem);
    for (double const z : {100.0, 120.0, 200.0, 300.0, 400.0}) {
        cones.contours.emplace_back(z, circle(top, 4.0 * (500.0 - z)));
    }
    Labels const labels = placed_on(cones).labels;
    ASSERT_EQ(labels.heights.size(), 1U); // the more important of two in the same place
    EXPECT_EQ(labels.heights[0].text, "500");
    for (char const* const z : {"100", "200", "300", "400"}) {
        EXPECT_TRUE(std::any_of(labels.contours.begin(), labels.contours.end(), [&](Label const& label) {
            return label.text == z;
        })) << z;
    }
    EXPECT_TRUE(std::none_of(labels.contours.begin(), labels.contours.end(),
                             [](Label const& label) { return label.text == "120"; }));
}

namespace {

/// Whether an odd number of sides lies east of a point.
bool is_within(draw::Shores const& shores, Vec2 p) {
    bool inside = false;
    for (std::vector<Vec2> const& line : shores) {
        for (std::size_t i = 1; i < line.size(); ++i) {
            Vec2 const a = line[i - 1];
            Vec2 const b = line[i];
            if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) {
                inside = !inside;
            }
        }
    }
    return inside;
}

/// How many of the nine cells around one are water; beyond the border those on it count again.
int water_around(Mask const& water, Cell c) {
    int count = 0;
    for (std::int64_t row = c.row - 1; row <= c.row + 1; ++row) {
        for (std::int64_t col = c.col - 1; col <= c.col + 1; ++col) {
            count += water[Cell{std::clamp<std::int64_t>(col, 0, water.width() - 1),
                                std::clamp<std::int64_t>(row, 0, water.height() - 1)}];
        }
    }
    return count;
}

} // namespace

RC_GTEST_PROP(Shores, CloseAroundWater, ()) {
    Mask water(Grid{*rc::gen::inRange(1, 12), *rc::gen::inRange(1, 12), 5.0, 100.0, 200.0, ""});
    for (std::uint8_t& cell : water.values()) {
        cell = *rc::gen::inRange<std::uint8_t>(0, 2);
    }
    draw::Shores const shores = draw::shores(water);
    for (std::vector<Vec2> const& line : shores) {
        RC_ASSERT(line.size() > 3U);
        RC_ASSERT(line.front() == line.back());
    }
    for (std::int64_t i = 0; i < water.cells(); ++i) {
        Cell const c = water.grid().at(i);
        int const wet = water_around(water, c);
        if (wet == 0 || wet == 9) {
            RC_ASSERT(is_within(shores, water.grid().centre(c)) == (wet == 9));
        }
    }
}

TEST(Figures, AreThoseOfTheReportPage) {
    EXPECT_EQ(draw::figures(1024.0, 7), "1\u2009024");
    EXPECT_EQ(draw::figures(30.72, 3), "30.7");
    EXPECT_EQ(draw::figures(56.25, 3), "56.3");
    EXPECT_EQ(draw::figures(3.0, 3), "3");
    EXPECT_EQ(draw::figures(0.0, 4), "0");
    EXPECT_EQ(draw::figures(-1234567.0, 4), "\u22121\u2009234\u2009567");
    EXPECT_EQ(draw::figures(99.996, 4), "100");
}

TEST(Lines, HoldWhatFits) {
    draw::TextStyle const style{10.0};
    std::vector<std::string> const texts = {"one", "two", "three"};
    EXPECT_EQ(draw::lines_within(texts, style, 1000.0), std::vector<std::string>{"one · two · three"});
    EXPECT_EQ(draw::lines_within(texts, style, 1.0), texts);
    EXPECT_TRUE(draw::lines_within({}, style, 10.0).empty());
}

} // namespace labels_test
