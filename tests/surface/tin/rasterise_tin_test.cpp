// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/tin/rasterise_tin.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>
#include <tins.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/geometry/nearby.hpp>
#include <thalweg/geometry/triangles.hpp>
#include <thalweg/geometry/triangulate.hpp>

namespace rasterise_tin_test {

using namespace thalweg;
using surface::rasterise_tin;
using Outside = surface::RasteriseTinParams::Outside;

namespace {

using test::has;
using test::message_of;
using test::on_threads;
using test::same_bits;

Tin triangle() {
    return {{{0, 0, 1}, {4, 0, 5}, {0, 4, 9}}, {{0, 1, 2}}};
}

std::string refusal(Tin const& tin) {
    return message_of<BadInput>([&] { rasterise_tin(tin, {4, 4, 1.0, 0.0, 4.0, ""}); });
}

double height_in(Tin const& tin, std::array<std::uint32_t, 3> const& t, Vec2 p) {
    return geometry::height_on_plane(tin.vertices[t[0]], tin.vertices[t[1]], tin.vertices[t[2]], p);
}

bool holds(Tin const& tin, std::array<std::uint32_t, 3> const& t, Vec2 p) {
    for (std::size_t k = 0; k < 3; ++k) {
        if (geometry::side_of_line(in_plan(tin.vertices[t[k]]), in_plan(tin.vertices[t[(k + 1) % 3]]), p) < 0) {
            return false;
        }
    }
    return true;
}

/// Twice the area over the longest side squared: in slivers below 1e-9 doubles cannot tell heights.
double fatness(Tin const& tin, std::array<std::uint32_t, 3> const& t) {
    double longest = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        longest = std::max(longest, distance(in_plan(tin.vertices[t[k]]), in_plan(tin.vertices[t[(k + 1) % 3]])));
    }
    return test::area2(tin.vertices[t[0]], tin.vertices[t[1]], tin.vertices[t[2]]) / (longest * longest);
}

/// Point in triangle, all of them; on shared sides every triangle has the same height, and the fattest tells it best.
void expect_as_by_hand(Tin const& tin, Raster<float> const& dem) {
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Vec2 const p = dem.grid().centre(dem.grid().at(i));
        std::array<std::uint32_t, 3> const* fattest = nullptr;
        for (auto const& t : tin.triangles) {
            if (holds(tin, t, p) && (fattest == nullptr || fatness(tin, t) > fatness(tin, *fattest))) {
                fattest = &t;
            }
        }
        RC_ASSERT((fattest == nullptr) == std::isnan(dem[i]));
        if (fattest == nullptr) {
            continue;
        }
        auto const z = static_cast<double>(dem[i]);
        if (fatness(tin, *fattest) > 1e-9) {
            RC_ASSERT(std::fabs(height_in(tin, *fattest, p) - z) < 1e-4);
        } else {
            auto const corner = [&](std::size_t k) { return tin.vertices[(*fattest)[k]].z; };
            RC_ASSERT(z >= std::min({corner(0), corner(1), corner(2)}) - 1e-4);
            RC_ASSERT(z <= std::max({corner(0), corner(1), corner(2)}) + 1e-4);
        }
    }
}

} // namespace

TEST(RasteriseTin, UnsoundTinsAreRefused) {
    Tin tin = triangle();
    tin.triangles[0] = {0, 2, 1};
    EXPECT_TRUE(has(refusal(tin), "triangle 1 at (0, 0) does not run counterclockwise"));
    tin.triangles[0] = {0, 1, 3};
    EXPECT_TRUE(has(refusal(tin), "triangle 1 has vertex 4 of 3"));
    tin.triangles[0] = {0, 1, 1};
    EXPECT_TRUE(has(refusal(tin), "does not run counterclockwise"));
    tin = triangle();
    tin.vertices[1].z = INFINITY;
    EXPECT_TRUE(has(refusal(tin), "vertex 2 is not finite"));
}

TEST(RasteriseTin, NoTriangleGivesNoHeight) {
    for (auto const outside : {Outside::no_data, Outside::nearest}) {
        auto const dem = rasterise_tin({}, {2, 2, 1.0, 0.0, 2.0, ""}, {outside});
        EXPECT_TRUE(std::ranges::all_of(dem.values(), [](float z) { return std::isnan(z); }));
        EXPECT_EQ(rasterise_tin(triangle(), {}, {outside}).cells(), 0);
    }
}

// Law: a centre in the TIN, its edge included, has the height there, one outside has none. Oracle: every triangle.
TEST(RasteriseTin, IsPointInTriangle) {
    ASSERT_TRUE(rc::check([] {
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30);
        int const steps = *rc::gen::element(0, 10, 20);
        auto points = test::random_points(*rc::gen::inRange<std::size_t>(3, 40), 20.0, seed, steps);
        points.push_back({3, 3, 5});
        points.push_back({4, 3, 5});
        points.push_back({3, 5, 7});
        double const shift = *rc::gen::element(0.0, 4e6, -1.0 / 3.0);
        for (Vec3& p : points) {
            p.x += shift;
            p.y -= shift;
        }
        Tin const tin = geometry::triangulate(points).tin;
        double const cell_m = *rc::gen::element(1.0, 0.5, 1.0 / 3.0, 7.0);
        double const west = *rc::gen::element(-0.5, 0.0, 0.1, 5.0);
        Grid const grid{30, 35, cell_m, west + shift, 20.5 - shift, ""};
        auto const dem = rasterise_tin(tin, grid);
        expect_as_by_hand(tin, dem);
        thalweg::Run const one = on_threads(1);
        RC_ASSERT(same_bits(dem, rasterise_tin(tin, grid, {}, one)));
    }));
}

TEST(RasteriseTin, SliversLeaveNoGap) {
    // A fan of slivers whose sides pass within rounding of the centres.
    std::vector<Vec3> points{{0, 0, 0}, {1000, 0, 0}, {1000, 1000, 0}, {0, 1000, 0}};
    for (int i = 0; i < 300; ++i) {
        points.push_back({i + 0.5, i + 0.5 + 1e-13 * i, 1.0});
        points.push_back({700.5 + 1e-10 * i, i + 0.25, 1.0});
    }
    auto const dem = rasterise_tin(geometry::triangulate(points).tin, {1000, 1000, 1.0, 0.0, 1000.0, ""});
    EXPECT_TRUE(std::ranges::none_of(dem.values(), [](float z) { return std::isnan(z); }));
    EXPECT_TRUE(std::ranges::all_of(dem.values(), [](float z) { return z >= 0.0F && z <= 1.0F; }));
}

TEST(RasteriseTin, OutsideTakesTheNearestHeight) {
    ASSERT_TRUE(rc::check([] {
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30);
        auto points = test::random_points(12, 10.0, seed);
        Tin tin = geometry::triangulate(points).tin;
        auto const dem = rasterise_tin(tin, {20, 20, 1.0, -5.0, 15.0, ""}, {Outside::nearest});
        auto const inside = rasterise_tin(tin, dem.grid());
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            if (!std::isnan(inside[i])) {
                RC_ASSERT(dem[i] == inside[i]);
                continue;
            }
            Vec2 const p = dem.grid().centre(dem.grid().at(i));
            double least = std::numeric_limits<double>::infinity();
            double z = 0.0;
            for (auto const& [side, count] : test::sides_of(tin)) {
                if (count == 1) {
                    Vec3 const a = tin.vertices[side.first];
                    Vec3 const b = tin.vertices[side.second];
                    auto const foot = geometry::foot_on(in_plan(a), in_plan(b), p);
                    if (distance(foot.at, p) < least) {
                        least = distance(foot.at, p);
                        z = a.z + foot.along * (b.z - a.z);
                    }
                }
            }
            RC_ASSERT(std::fabs(z - static_cast<double>(dem[i])) < 1e-4);
        }
    }));
}

TEST(RasteriseTin, ThreadsChangeNoByte) {
    Tin const tin = geometry::triangulate(test::random_points(20000, 500.0, 3, 400)).tin;
    Grid const grid{520, 530, 1.0, -10.5, 510.5, ""};
    for (auto const outside : {Outside::no_data, Outside::nearest}) {
        thalweg::Run const one = on_threads(1);
        thalweg::Run const many = on_threads(7);
        EXPECT_TRUE(same_bits(rasterise_tin(tin, grid, {outside}, one), rasterise_tin(tin, grid, {outside}, many)));
    }
}

} // namespace rasterise_tin_test
