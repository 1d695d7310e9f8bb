// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <support.hpp>

#include <thalweg/io/mesh/tin.hpp>
#include <thalweg/io/raster/raster_files.hpp>

#include "blend_runs.hpp"

namespace blend_mesh_test {

using blend_runs::blend;
using blend_runs::refused;

namespace fs = std::filesystem;
using namespace thalweg;

namespace {

/// A mesh of squares in Wavefront OBJ.
std::string obj(int cells, double side_m, Vec2 from, std::function<double(double, double)> const& height,
                std::string const& crs = "EPSG:32631") {
    std::string text = crs.empty() ? "" : "# crs " + crs + "\n";
    for (int row = 0; row <= cells; ++row) {
        for (int col = 0; col <= cells; ++col) {
            double const x = from.x + side_m * col;
            double const y = from.y + side_m * row;
            text += "v " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(height(x, y)) + "\n";
        }
    }
    for (int row = 0; row < cells; ++row) {
        for (int col = 0; col < cells; ++col) {
            int const sw = row * (cells + 1) + col + 1;
            int const nw = sw + cells + 1;
            text += "f " + std::to_string(sw) + " " + std::to_string(sw + 1) + " " + std::to_string(nw) + "\n";
            text += "f " + std::to_string(sw + 1) + " " + std::to_string(nw + 1) + " " + std::to_string(nw) + "\n";
        }
    }
    return text;
}

double level(double /*x*/, double /*y*/) {
    return 50.0;
}

/// A tent over the square from 30 to 50, 7 m high.
double tent(double x, double y) {
    return 7.0 * std::max(0.0, 1.0 - std::max(std::fabs(x - 40.0), std::fabs(y - 40.0)) / 10.0);
}

void write_meshes(Workplace const& place) {
    place.write("land.obj", obj(10, 10.0, {0, 0}, level));
    place.write("hill.obj", obj(10, 2.0, {30, 30}, tent, ""));
}

} // namespace

TEST(BlendMesh, AHillStandsOnLevelLand) {
    Workplace const place;
    write_meshes(place);
    Outcome const o = blend(place, "land.obj hill.obj -o both.obj --json");
    ASSERT_EQ(o.code, 0) << o.err;
    auto const json = nlohmann::json::parse(o.out);
    EXPECT_EQ(json["place"], "own");
    EXPECT_EQ(json["at"], nlohmann::json::parse("[40.0, 40.0]"));
    EXPECT_EQ(json["removed"], 1); // (40, 40); 8 of the target's vertices lie on the outline
    EXPECT_EQ(json["inner"], 81);
    EXPECT_EQ(json["added"], 40 - 8);
    io::TinFile const both = io::read_tin((place / "both.obj").string());
    EXPECT_EQ(both.crs, "EPSG:32631");
    EXPECT_EQ(both.tin.vertices.size(), json["vertices"]);
    EXPECT_EQ(both.tin.triangles.size(), json["triangles"]);
    for (Vec3 const& v : both.tin.vertices) {
        EXPECT_NEAR(v.z, 50.0 + tent(v.x, v.y), 1e-6);
    }
}

TEST(BlendMesh, IsMovedTurnedScaledAndRaised) {
    Workplace const place;
    write_meshes(place);
    Outcome const o = blend(place, "land.obj hill.obj -o both.2dm --at 61,57 --rotate 90 --scale 2 --gain 3");
    ASSERT_EQ(o.code, 0) << o.err;
    io::TinFile const both = io::read_tin((place / "both.2dm").string());
    double highest = 0.0;
    for (Vec3 const& v : both.tin.vertices) {
        highest = std::max(highest, v.z);
        EXPECT_NEAR(v.z, 50.0 + 3.0 * tent(40.0 + (v.x - 61.0) / 2.0, 40.0 + (v.y - 57.0) / 2.0), 1e-5);
    }
    EXPECT_NEAR(highest, 71.0, 1e-6);
    place.write("far.obj", obj(4, 5.0, {900, 900}, tent));
    Outcome const far = blend(place, "land.obj far.obj -o far.off --json");
    ASSERT_EQ(far.code, 0) << far.err;
    EXPECT_EQ(nlohmann::json::parse(far.out)["place"], "middle");
    EXPECT_EQ(nlohmann::json::parse(far.out)["at"], nlohmann::json::parse("[50.0, 50.0]"));
}

TEST(BlendMesh, QuadrilateralsAreCutIntoTriangles) {
    Workplace const place;
    write_meshes(place);
    std::string land = "MESH2D\n";
    for (int i = 0; i < 36; ++i) {
        land += "ND " + std::to_string(i + 1) + " " + std::to_string(20 * (i % 6)) + " " +
                std::to_string(20 * (i / 6)) + " 50\n";
    }
    for (int i = 1; i <= 29; ++i) {
        if (i % 6 != 0) {
            land += "E4Q " + std::to_string(i) + " " + std::to_string(i) + " " + std::to_string(i + 1) + " " +
                    std::to_string(i + 7) + " " + std::to_string(i + 6) + " 1\n";
        }
    }
    place.write("land.2dm", land);
    Outcome const o = blend(place, "land.2dm hill.obj -o both.obj --source-crs EPSG:32632");
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_TRUE(test::has(o.err, "land.2dm: 25 faces with more than three corners are cut into triangles"));
    io::TinFile const both = io::read_tin((place / "both.obj").string());
    EXPECT_EQ(both.crs, "EPSG:32632");
    for (Vec3 const& v : both.tin.vertices) {
        EXPECT_NEAR(v.z, 50.0 + tent(v.x, v.y), 1e-6);
    }
}

TEST(BlendMesh, TheExampleOfTheHelpRuns) {
    Workplace const place;
    place.write("land.obj", obj(10, 100.0, {511500, 4989500}, level));
    place.write("hill.obj", obj(10, 20.0, {0, 0}, tent, ""));
    std::string const help = thalweg_run("help blend", place.path()).out;
    auto const at = help.find("thalweg blend land.obj");
    ASSERT_NE(at, std::string::npos) << help;
    std::string const example = help.substr(at + 8, help.find('\n', at) - at - 8);
    Outcome const o = expect_run(place, example, 0);
    EXPECT_EQ(o.out, "both.obj\n");
}

TEST(BlendMesh, ATurnedMeshIsTheSameOnAnyThreads) {
    Workplace const place;
    write_meshes(place);
    std::string const arguments = "land.obj hill.obj --at 51.3,48.9 --rotate 33 ";
    ASSERT_EQ(blend(place, arguments + "-o one.obj --threads 1").code, 0);
    ASSERT_EQ(blend(place, arguments + "-o two.obj --threads 2").code, 0);
    EXPECT_EQ(file_bytes(place / "one.obj"), file_bytes(place / "two.obj"));
}

TEST(BlendMesh, RefusesWhatItCannotUse) {
    Workplace const place;
    write_meshes(place);
    io::write_dem(Raster<float>(Grid{20, 20, 10.0, 0.0, 200.0, "EPSG:32631"}, 1.0F), (place / "dem.tif").string());
    place.write("abroad.obj", obj(4, 5.0, {30, 30}, tent, "EPSG:32632"));
    place.write("hole.obj", [] {
        std::string text = obj(3, 5.0, {30, 30}, tent);
        for (std::string const face : {"f 6 7 10\n", "f 7 11 10\n"}) {
            text.erase(text.find(face), face.size());
        }
        return text;
    }());
    place.write("upright.obj", "v 30 30 0\nv 40 30 0\nv 40 30 5\nf 1 2 3\n");
    std::string const rest = " -o out.obj";
    refused(place, "dem.tif hill.obj" + rest, "dem.tif is not a mesh");
    refused(place, "land.obj dem.tif" + rest, "dem.tif is not a mesh");
    refused(place, "land.obj none.obj" + rest, "none.obj");
    refused(place, "land.obj hill.obj --at 95,50" + rest, "leaves the target");
    refused(place, "land.obj hill.obj --at 950,50" + rest, "off the target");
    refused(place, "land.obj hill.obj --at 95" + rest, "it takes two");
    refused(place, "land.obj hill.obj --scale 0" + rest, "scale of 0");
    refused(place, "land.obj hill.obj --gain inf" + rest, "gain of inf");
    refused(place, "land.obj abroad.obj" + rest, "abroad.obj is in EPSG:32632, land.obj in EPSG:32631");
    refused(place, "land.obj hole.obj" + rest, "several boundaries");
    refused(place, "land.obj upright.obj" + rest, "has no area in plan");
    refused(place, "land.obj hill.obj -o out.tif", "2dm");
    for (std::string const option :
         {"--window 0,0,2,2", "--mask dem.tif", "--keep dem.tif", "--feather 3", "--mixed", "--fill-holes"}) {
        refused(place, "land.obj hill.obj " + option + rest, option.substr(0, option.find(' ')) + " is for DEMs");
    }
    ASSERT_EQ(blend(place, "land.obj hill.obj" + rest).code, 0);
    refused(place, "land.obj hill.obj" + rest, "--overwrite");
}

} // namespace blend_mesh_test
