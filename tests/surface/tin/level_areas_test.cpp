// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/tin/level_areas.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/geometry/triangulate.hpp>
#include <thalweg/surface/tin/rasterise_tin.hpp>

namespace level_areas_test {

using namespace thalweg;
using surface::level_share;
using surface::medial_points;

namespace {

using Lines = std::vector<std::vector<Vec3>>;

/// Rings of a hill, radii [m] from the outermost.
Lines rings(std::vector<double> const& radii, double interval_m) {
    Lines lines;
    for (std::size_t i = 0; i < radii.size(); ++i) {
        std::vector<Vec3> ring;
        constexpr int count = 48;
        for (int k = 0; k <= count; ++k) {
            double const angle = 6.283185307179586 * (k % count) / count;
            ring.push_back(
                {radii[i] * std::cos(angle), radii[i] * std::sin(angle), interval_m * static_cast<double>(i + 1)});
        }
        lines.push_back(std::move(ring));
    }
    return lines;
}

/// Contours of z = 0.1 y + 0.2 |x|: a valley that falls to the south.
Lines valley() {
    Lines lines;
    for (int h = 0; h <= 100; h += 10) {
        std::vector<Vec3> line;
        for (int x = -300; x <= 300; x += 15) {
            double const y = 10.0 * (h - 0.2 * std::abs(x));
            line.push_back({static_cast<double>(x), y, static_cast<double>(h)});
        }
        lines.push_back(std::move(line));
    }
    return lines;
}

double rms_against(Tin const& tin, std::function<double(Vec2)> const& truth, Grid const& grid) {
    Raster<float> const z = surface::rasterise_tin(tin, grid);
    double sum = 0.0;
    double count = 0.0;
    for (std::int64_t i = 0; i < z.cells(); ++i) {
        if (!std::isnan(z[i])) {
            double const off = static_cast<double>(z[i]) - truth(grid.centre(grid.at(i)));
            sum += off * off;
            ++count;
        }
    }
    return std::sqrt(sum / count);
}

} // namespace

TEST(LevelAreas, ASummitRisesLessThanAnInterval) {
    Lines const hill = rings({400, 300, 200, 100}, 10.0);
    auto const flat = geometry::triangulate({}, hill);
    std::vector<Vec3> const points = medial_points(flat);
    ASSERT_FALSE(points.empty());
    for (Vec3 const& p : points) {
        EXPECT_GT(p.z, 40.0);
        EXPECT_LT(p.z, 50.0);
        EXPECT_LT(norm(in_plan(p)), 100.0);
    }
    auto const cured = geometry::triangulate(points, hill);
    EXPECT_GT(level_share(flat.tin), 0.05);
    EXPECT_LT(level_share(cured.tin), 0.005);
}

TEST(LevelAreas, AValleyFallsBetweenItsContours) {
    auto const truth = [](Vec2 p) { return 0.1 * p.y + 0.2 * std::fabs(p.x); };
    Lines const contours = valley();
    auto const flat = geometry::triangulate({}, contours);
    std::vector<Vec3> const points = medial_points(flat);
    auto const cured = geometry::triangulate(points, contours);
    Grid grid;
    grid.width = 40;
    grid.height = 80;
    grid.cell_m = 10.0;
    grid.west = -200.0;
    grid.north = 900.0;
    EXPECT_GT(level_share(flat.tin), 0.1);
    EXPECT_LT(level_share(cured.tin), 0.02);
    EXPECT_LT(rms_against(cured.tin, truth, grid), 0.6 * rms_against(flat.tin, truth, grid));
}

TEST(LevelAreas, WithoutAnotherHeightNothingIsAdded) {
    EXPECT_TRUE(medial_points(geometry::triangulate({}, rings({100}, 10.0))).empty());
}

TEST(LevelAreas, TheOrderOfLinesDoesNotMatter) {
    Lines lines = valley();
    auto const key = [](Vec3 const& a, Vec3 const& b) { return std::tie(a.x, a.y) < std::tie(b.x, b.y); };
    std::vector<Vec3> first = medial_points(geometry::triangulate({}, lines));
    std::ranges::reverse(lines);
    std::vector<Vec3> second = medial_points(geometry::triangulate({}, lines));
    ASSERT_EQ(first.size(), second.size());
    std::ranges::sort(first, key);
    std::ranges::sort(second, key);
    for (std::size_t i = 0; i < first.size(); ++i) {
        EXPECT_EQ(in_plan(first[i]), in_plan(second[i]));
        EXPECT_NEAR(first[i].z, second[i].z, 0.5);
    }
}

} // namespace level_areas_test
