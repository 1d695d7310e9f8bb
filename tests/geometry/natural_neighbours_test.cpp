// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/natural_neighbours.hpp>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>
#include <tins.hpp>

#include <thalweg/core/run/error.hpp>

namespace natural_neighbours_test {

using namespace thalweg;
using geometry::natural_neighbours;
using Outside = geometry::NaturalNeighboursParams::Outside;

namespace {

using test::on_threads;
using test::same_bits;

} // namespace

TEST(NaturalNeighbours, TooLittleIsRefused) {
    EXPECT_THROW(natural_neighbours({}, {4, 4, 1.0, 0.0, 4.0, ""}), BadInput);
    EXPECT_THROW(natural_neighbours({{0, 0, 0}, {1, 1, 0}, {2, 2, 0}}, {4, 4, 1.0, 0.0, 4.0, ""}), BadInput);
    EXPECT_THROW(natural_neighbours({{0, 0, NAN}, {1, 1, 0}, {2, 3, 0}}, {4, 4, 1.0, 0.0, 4.0, ""}), BadInput);
    EXPECT_EQ(natural_neighbours({{0, 0, 0}, {1, 1, 0}, {2, 3, 0}}, {}).cells(), 0);
}

// Law: planes are carried exactly; NaN only outside the hull, or nowhere.
TEST(NaturalNeighbours, PlanesStayPlanes) {
    ASSERT_TRUE(rc::check([] {
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30);
        auto points = test::random_points(*rc::gen::inRange<std::size_t>(0, 60), 20.0, seed, *rc::gen::element(0, 20));
        points.insert(points.end(), {{0, 0, 0}, {20, 0, 0}, {20, 20, 0}, {0, 20, 0}});
        auto const plane = [](double x, double y) { return 100.0 + 2.0 * x - 3.0 * y; };
        for (Vec3& p : points) {
            p.z = plane(p.x, p.y);
        }
        for (auto const outside : {Outside::no_data, Outside::nearest}) {
            auto const dem = natural_neighbours(points, {48, 48, 0.5, -2.0, 22.0, ""}, {outside});
            for (std::int64_t i = 0; i < dem.cells(); ++i) {
                Vec2 const p = dem.grid().centre(dem.grid().at(i));
                if (p.x >= 0 && p.x <= 20 && p.y >= 0 && p.y <= 20) {
                    RC_ASSERT(std::fabs(static_cast<double>(dem[i]) - plane(p.x, p.y)) < 1e-3);
                } else {
                    RC_ASSERT(std::isnan(dem[i]) == (outside == Outside::no_data));
                }
            }
        }
    }));
}

TEST(NaturalNeighbours, AreSibsonsAreas) {
    // Cell of the middle of a square of four points: each loses the same; off the middle the nearest loses most.
    std::vector<Vec3> const points{{0, 0, 8}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
    auto const dem = natural_neighbours(points, {3, 3, 1.0, 0.5, 3.5, ""});
    EXPECT_NEAR((dem[Cell{1, 1}]), 2.0F, 1e-6);
    EXPECT_GT((dem[Cell{0, 2}]), 4.0F);
    EXPECT_NEAR((dem[Cell{0, 0}]), (dem[Cell{2, 2}]), 1e-5); // mirrored
    // By symmetry these are the shares of the four corners at one place.
    double sum = 0.0;
    for (Cell const c : {Cell{0, 0}, Cell{2, 0}, Cell{0, 2}, Cell{2, 2}}) {
        sum += static_cast<double>(dem[c]);
    }
    EXPECT_NEAR(sum, 8.0, 1e-5);
}

TEST(NaturalNeighbours, StayWithinTheHeightsAndMeetThePoints) {
    auto const points = test::random_points(200, 32.0, 4, 32);
    auto const dem = natural_neighbours(points, {32, 32, 1.0, -0.5, 31.5, ""}, {Outside::nearest});
    for (std::size_t i = 0; i < points.size(); ++i) {
        auto const twin =
            std::ranges::find_if(points, [&](Vec3 const& p) { return p.x == points[i].x && p.y == points[i].y; });
        if (Cell const c = dem.grid().cell_of({points[i].x, points[i].y}); dem.grid().contains(c)) {
            EXPECT_EQ(dem[c], static_cast<float>(twin->z));
        }
    }
    EXPECT_TRUE(std::ranges::all_of(dem.values(), [](float z) { return z >= 0.0F && z <= 100.0F; }));
}

TEST(NaturalNeighbours, ThreadsChangeNoByte) {
    auto const points = test::random_points(3000, 90.0, 8, 60);
    Grid const grid{100, 110, 1.0, -5.0, 100.0, ""};
    thalweg::Run const one = on_threads(1);
    thalweg::Run const many = on_threads(6);
    EXPECT_TRUE(same_bits(natural_neighbours(points, grid, {}, one), natural_neighbours(points, grid, {}, many)));
}

} // namespace natural_neighbours_test
