// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Points and ends of ridges on the grid's outer edge: the land is as with the same place within its cell.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <io/scratch_folder.hpp>
#include <make/made.hpp>
#include <support.hpp>

#include <thalweg/core/raster.hpp>

namespace border_test {

using namespace thalweg;
using namespace thalweg::make;

namespace {

Grid const ground{40, 40, 16.0, 500000.0, 5000640.0, ""};

/// Places on and near each border and corner.
std::vector<Vec2> places() {
    double const middle_x = 0.3 * ground.west + 0.7 * ground.east();
    double const middle_y = 0.4 * ground.north + 0.6 * ground.south();
    double const near = 0.1 * ground.cell_m;
    std::vector<Vec2> all;
    for (double const inside : {0.0, near}) {
        for (double const x : {ground.west + inside, middle_x, ground.east() - inside}) {
            for (double const y : {ground.south() + inside, middle_y, ground.north - inside}) {
                if (x != middle_x || y != middle_y) {
                    all.push_back({x, y});
                }
            }
        }
    }
    for (double const x : {ground.west, ground.east()}) { // where another cell begins
        for (double const row : {17.0, 39.0}) {
            all.push_back({x, ground.north - row * ground.cell_m});
        }
    }
    return all;
}

/// A millimetre off the outer edge.
Vec2 just_inside(Vec2 p) {
    return {std::clamp(p.x, ground.west + 1e-3, ground.east() - 1e-3),
            std::clamp(p.y, ground.south() + 1e-3, ground.north - 1e-3)};
}

/// The middle of the outermost cell that a place lies in.
Vec2 in_its_cell(Vec2 p) {
    auto const slot = [](double along) { return std::min(std::floor(along / ground.cell_m), 39.0) + 0.5; };
    return {ground.west + slot(p.x - ground.west) * ground.cell_m,
            ground.north - slot(ground.north - p.y) * ground.cell_m};
}

std::string const grid_words = "[grid]\nwidth = 40\nheight = 40\ncell = 16\norigin = [500000, 5000640]\n";
std::string const rivers_words =
    grid_words + "[network]\nsource = \"lines\"\n[network.lines]\npath = \"rivers.geojson\"\n";

std::string recipe_of(std::string const& method, std::string const& feature) {
    std::string const surface = "[surface]\nmethod = \"" + method + "\"\n";
    return (method == "regress" ? grid_words : rivers_words) + "[skeleton]\n" + feature + "\n" + surface;
}

MakeResult made_with(std::string const& method, std::string const& feature, std::vector<std::string> const& rows,
                     ScratchFolder const& folder) {
    folder.write("rivers.geojson", test::geojson(test::line("[500312,5000500],[500330,5000250],[500312,5000008]", "")));
    std::string points = "x,y,z\n";
    for (std::string const& row : rows) {
        points += row + "\n";
    }
    folder.write("points.csv", points);
    return test::made(recipe_of(method, feature), folder.path().string());
}

Raster<float> land_with_point(std::string const& method, Vec2 p, ScratchFolder const& folder) {
    std::vector<std::string> rows{fmt::format("{},{},900", p.x, p.y)};
    if (method == "regress") { // of many points
        for (int i = 0; i < 60; ++i) {
            rows.push_back(
                fmt::format("{},{},{}", 500020 + 37 * (i % 8) * 2, 5000020 + 71 * (i / 8), 300 + 7 * (i % 11)));
        }
    }
    return made_with(method, "points = \"points.csv\"", rows, folder).terrain.ground.dem;
}

Raster<float> land_with_ridge(std::string const& method, Vec2 p, ScratchFolder const& folder) {
    Vec2 const inside{p.x < 500312 ? 500100.0 : 500500.0, 5000300};
    folder.write("ridges.geojson",
                 test::geojson(test::line(fmt::format("[{},{},900],[{},{},900]", p.x, p.y, inside.x, inside.y))));
    return made_with(method, "ridge_lines = \"ridges.geojson\"", {}, folder).terrain.ground.dem;
}

/// The greatest difference of two DEMs.
double apart_m(Raster<float> const& a, Raster<float> const& b) {
    double most = 0.0;
    for (std::int64_t i = 0; i < a.cells(); ++i) {
        most = std::max(most, static_cast<double>(std::fabs(a[i] - b[i])));
    }
    return most;
}

} // namespace

// Over cells a place is its cell's. Over triangles and by regression it is itself: the land does not jump at the
// border.
TEST(Border, PointsOnItAreThoseOfTheirCell) {
    ScratchFolder const folder;
    ASSERT_GE(places().size(), 20U);
    for (Vec2 const p : places()) {
        for (char const* const method : {"equilibrium", "dilate", "diffuse"}) {
            EXPECT_EQ(apart_m(land_with_point(method, p, folder), land_with_point(method, in_its_cell(p), folder)), 0.0)
                << method << " " << p.x << " " << p.y;
        }
        for (char const* const method : {"tin", "regress"}) {
            EXPECT_LE(apart_m(land_with_point(method, p, folder), land_with_point(method, just_inside(p), folder)), 0.1)
                << method << " " << p.x << " " << p.y;
        }
    }
}

TEST(Border, RidgesThatEndOnItAreThoseOfTheirCell) {
    ScratchFolder const folder;
    for (Vec2 const p : places()) {
        for (char const* const method : {"equilibrium", "dilate", "diffuse"}) {
            EXPECT_EQ(apart_m(land_with_ridge(method, p, folder), land_with_ridge(method, in_its_cell(p), folder)), 0.0)
                << method << " " << p.x << " " << p.y;
        }
        EXPECT_LE(apart_m(land_with_ridge("tin", p, folder), land_with_ridge("tin", just_inside(p), folder)), 0.1)
            << p.x << " " << p.y;
    }
}

} // namespace border_test
