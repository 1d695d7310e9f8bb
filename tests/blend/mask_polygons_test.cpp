// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/blend/mask_polygons.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

#include "lands.hpp"

namespace mask_polygons_test {

using namespace thalweg;
using blend::mask_polygons;
using blend::number_polygons;

namespace {

using test::full_message_of;

Polygons of(std::vector<Polygon> polygons) {
    return {std::move(polygons), "", "shapes.gpkg"};
}

std::vector<Vec2> ring_by_chance(std::uint64_t seed, std::uint64_t vertices, double side) {
    std::vector<Vec2> ring;
    for (std::uint64_t i = 0; i < vertices; ++i) {
        auto const words = random_block(seed, i);
        ring.push_back({(1.6 * unit(words[0]) - 0.3) * side, (1.6 * unit(words[1]) - 0.3) * side});
    }
    return ring;
}

/// Turns of a ring around a point, by the angles its edges are seen under.
bool is_inside(std::vector<Vec2> const& ring, Vec2 p) {
    bool odd = false;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        Vec2 const a = ring[i];
        Vec2 const b = ring[(i + 1) % ring.size()];
        bool const spans = (a.y > p.y) != (b.y > p.y);
        odd = odd != (spans && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x));
    }
    return odd;
}

} // namespace

TEST(MaskPolygons, RefusesWhatHoldsNoCell) {
    Grid const grid = test::frame(4, 3, 10.0);
    auto const refused = [&](Polygons const& polygons) {
        return full_message_of<BadInput>([&] { mask_polygons(polygons, grid); });
    };
    EXPECT_TRUE(test::has(refused(of({})), "the 0 polygons of shapes.gpkg"));
    EXPECT_TRUE(test::has(refused(of({{7, {{{0, 0}, {1, 1}}}}})), "feature 7 of shapes.gpkg"));
    EXPECT_TRUE(test::has(refused(of({{7, {{{0, 0}, {1, 1}, {std::nan(""), 0}}}}})), "vertex 3 of feature 7"));
    EXPECT_TRUE(test::has(refused(of({{1, {{{100, 0}, {120, 0}, {110, 20}}}}})), "the 1 polygons of shapes.gpkg"));
    EXPECT_TRUE(test::has(refused(of({{1, {{{1, 1}, {2, 1}, {1, 2}}}}})), "hold the centre of no cell"));
}

TEST(MaskPolygons, EqualsAPointInPolygonTest) {
    ASSERT_TRUE(rc::check("even-odd within a polygon, of several the last", [] {
        Grid const grid = test::frame(17, 13, 2.0);
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1000000).as("seed");
        auto const vertices = *rc::gen::inRange<std::uint64_t>(3, 9).as("vertices");
        Polygons const polygons = of({{1, {ring_by_chance(seed, vertices, 30.0), ring_by_chance(seed + 1, 4, 30.0)}},
                                      {2, {ring_by_chance(seed + 2, 3, 30.0)}}});
        Raster<std::int32_t> wanted(grid);
        bool any = false;
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            Vec2 const p = grid.centre(grid.at(i));
            auto const& rings = polygons.polygons[0].rings;
            bool const in = is_inside(rings[0], p) != is_inside(rings[1], p);
            wanted[i] = is_inside(polygons.polygons[1].rings[0], p) ? 2 : in ? 1 : 0;
            any = any || wanted[i] != 0;
        }
        if (!any) {
            RC_ASSERT_THROWS_AS(mask_polygons(polygons, grid), BadInput);
            return;
        }
        Raster<std::int32_t> const numbers = number_polygons(polygons, grid);
        Mask const mask = mask_polygons(polygons, grid);
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            RC_ASSERT(numbers[i] == wanted[i]);
            RC_ASSERT(mask[i] == (wanted[i] != 0 ? 1 : 0));
        }
    }));
}

TEST(MaskPolygons, CentresOnASharedEdgeBelongToOne) {
    Grid const grid = test::frame(6, 6);
    // Edges through centres, level, upright and aslant.
    Polygon const west{1, {{{0, 0}, {2.5, 0}, {2.5, 2.5}, {4.5, 4.5}, {0, 4.5}}}};
    Polygon const east{2, {{{2.5, 0}, {6, 0}, {6, 4.5}, {4.5, 4.5}, {2.5, 2.5}}}};
    Polygon const north{3, {{{0, 4.5}, {4.5, 4.5}, {6, 4.5}, {6, 6}, {0, 6}}}};
    Mask const a = mask_polygons(of({west}), grid);
    Mask const b = mask_polygons(of({east}), grid);
    Mask const c = mask_polygons(of({north}), grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        EXPECT_EQ(a[i] + b[i] + c[i], 1) << i;
    }
}

TEST(MaskPolygons, FarCoordinatesAreClipped) {
    Grid const grid = test::frame(5, 5);
    Mask const mask =
        mask_polygons(of({{1, {{{-1e300, -1e300}, {1e300, -1e300}, {1e300, 1e300}, {-1e300, 1e300}}}}}), grid);
    for (std::uint8_t const m : mask.values()) {
        EXPECT_EQ(m, 1);
    }
}

} // namespace mask_polygons_test
