// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Points and ridges that a user gives: the terrain goes through them, and it is said where it does not.
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/cells.hpp>
#include <thalweg/io/raster/raster_files.hpp>

#include "command.hpp"

namespace features_test {

namespace fs = std::filesystem;
using nlohmann::json;
using thalweg::Cell;
using thalweg::Raster;

namespace {

std::string const small = " -q --set grid.width=160 --set grid.height=128 --set grid.cell=30 --seed 3 ";

/// Places that are higher than all others eight cells around, as a file with heights a tenth higher or lower in turn.
std::vector<thalweg::Vec3> write_summits(Raster<float> const& dem, fs::path const& path) {
    constexpr std::int64_t apart = 8;
    std::vector<thalweg::Vec3> out;
    thalweg::Grid const& grid = dem.grid();
    for (std::int64_t row = apart; row < grid.height - apart; ++row) {
        for (std::int64_t col = apart; col < grid.width - apart; ++col) {
            bool highest = true;
            for (std::int64_t k = 0; k < 17 * 17; ++k) {
                Cell const c{col + k % 17 - apart, row + k / 17 - apart};
                highest = highest && (c == Cell{col, row} || dem[c] < dem[{col, row}]);
            }
            if (highest) {
                thalweg::Vec2 const at = grid.centre({col, row});
                double const factor = out.size() % 2 == 0 ? 1.1 : 0.9;
                out.push_back({at.x, at.y, std::round(factor * static_cast<double>(dem[{col, row}]))});
            }
        }
    }
    std::ofstream file(path);
    file << "x,y,z\n";
    for (thalweg::Vec3 const& p : out) {
        file << std::to_string(p.x) << "," << std::to_string(p.y) << "," << std::to_string(p.z) << "\n";
    }
    return out;
}

void write_ridge(fs::path const& path, thalweg::Vec3 const& a, thalweg::Vec3 const& b) {
    auto const place = [](thalweg::Vec3 const& p) {
        return "[" + std::to_string(p.x) + "," + std::to_string(p.y) + "]";
    };
    test::write(path, test::geojson(test::line(place(a) + "," + place(b))));
}

/// How many cells are lower than all around.
std::int64_t holes(Raster<float> const& dem) {
    std::int64_t count = 0;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        bool lowest = true;
        thalweg::cells_around(dem.grid(), dem.grid().at(i), 1,
                              [&](Cell c) { lowest = lowest && (c == dem.grid().at(i) || dem[i] < dem[c]); });
        count += lowest ? 1 : 0;
    }
    return count;
}

/// Mean distance of the asked heights.
double mean_off(json const& report) {
    double sum = 0.0;
    json const& points = report["features"]["points"]["each"];
    for (json const& p : points) {
        sum += std::fabs(static_cast<double>(p["z_m"]) - static_cast<double>(p["asked_m"]));
    }
    return sum / static_cast<double>(points.size());
}

} // namespace

TEST(Features, EveryMethodGoesThroughPoints) {
    Workplace const place;
    for (std::string const method : {"equilibrium", "dilate", "diffuse", "tin"}) {
        std::string const made = "make --only dem,network" + small + "--set surface.method=" + method + " ";
        expect_run(place, made + "-o before_" + method, 0);
        // Rivers have the heights that they have, and some summits of diffused terrain are heads of rivers.
        std::string const from = method == "equilibrium" ? "equilibrium" : "dilate";
        auto const summits = write_summits(thalweg::io::read_dem((place / ("before_" + from + "/dem.tif")).string()),
                                           place / (method + ".csv"));
        ASSERT_GE(summits.size(), 2U) << method;
        Outcome const run = expect_run(place,
                                       "make --only dem,network" + small.substr(3) + "--set surface.method=" + method +
                                           " --set skeleton.points=" + method + ".csv -o " + method,
                                       0, "points: off by");
        json const report = report_of(place / method);
        expect_checks_hold(report);
        EXPECT_EQ(report["features"]["points"]["count"], summits.size());
        double moved = 0.0; // mean
        for (thalweg::Vec3 const& p : summits) {
            moved += 0.1 * p.z / static_cast<double>(summits.size());
        }
        EXPECT_LT(mean_off(report), (method == "equilibrium" ? 0.5 : 0.05) * moved) << method;
        if (report["features"]["points"]["missed"] > 0) {
            EXPECT_NE(run.err.find("are missed by more than 1 m"), std::string::npos) << run.err;
        }
        expect_run(place, "replay " + method + " --verify", 0);
    }
}

TEST(Features, RidgesNeedNoHeights) {
    Workplace const place;
    expect_run(place, "make --only dem,network" + small + "-o before", 0);
    auto const summits =
        write_summits(thalweg::io::read_dem((place / "before/dem.tif").string()), place / "points.csv");
    write_ridge(place / "ridge.geojson", summits[0], summits[1]);
    for (std::string const method : {"equilibrium", "dilate", "diffuse", "tin"}) {
        expect_run(place,
                   "make --only dem,network" + small.substr(3) + "--set surface.method=" + method +
                       " --set skeleton.ridge_lines=ridge.geojson -o " + method,
                   0, "1 ridges of");
        json const report = report_of(place / method);
        json const& ridge = report["features"]["ridge_lines"]["each"][0];
        EXPECT_EQ(ridge["feature"], 1);
        EXPECT_GT(ridge["cells"], 5);
        EXPECT_LE(static_cast<double>(ridge["crossed"]), 0.1 * static_cast<double>(ridge["cells"]))
            << method << ridge.dump();
        EXPECT_EQ(report["ridges"]["count"], 1);
    }
}

TEST(Features, RandomPointsShapeWhatADilationRisesFromNotTheDilation) {
    Workplace const place;
    std::string const made = "make --only dem,network" + small +
                             "--set surface.method=dilate --set surface.base=tin --set surface.drain=none ";
    expect_run(place, made + "-o plain", 0);
    expect_run(place, made + "--set skeleton.scatter=40 --set skeleton.ridge_gain=0 -o scattered", 0);
    Raster<float> const plain = thalweg::io::read_dem((place / "plain/dem.tif").string());
    Raster<float> const scattered = thalweg::io::read_dem((place / "scattered/dem.tif").string());
    EXPECT_LT(holes(scattered), holes(plain) + 20); // 40 points as low as rivers dig none
}

TEST(Features, WhatLiesOffTheGridIsRefusedOrToldAndLeftOut) {
    Workplace const place;
    test::write(place / "far.csv", "x,y,z\n0,0,10\n502000,4998000,400\n");
    std::string const with = "make --only dem,network" + small.substr(3) + "--set skeleton.points=far.csv ";
    expect_run(place, with + "-o refused", 2, "far.csv", "point 1 at (0.000, 0.000) lies off the grid");
    write_ridge(place / "far.geojson", {0, 0, 0}, {502000, 4998000, 0});
    expect_run(place, "make --only dem,network" + small + "--set skeleton.ridge_lines=far.geojson -o refused_too", 2,
               "far.geojson", "feature 1 reaches (0.000, 0.000), off the grid");
    EXPECT_FALSE(fs::exists(place / "refused"));
}

} // namespace features_test
