// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/io/mesh/tin.hpp>
#include <thalweg/io/raster/raster_files.hpp>

#include "command.hpp"

namespace blend_mesh_test {

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

io::TinFile read(Workplace const& place, std::string const& name) {
    return io::read_tin((place / name).string());
}

} // namespace

TEST(BlendMesh, AHillStandsOnLevelLand) {
    Workplace const place;
    write_meshes(place);
    auto const json = expect_run(place, "blend land.obj hill.obj -o both.obj --json", 0).json();
    EXPECT_EQ(json["place"], "own");
    EXPECT_EQ(json["at"], nlohmann::json::parse("[40.0, 40.0]"));
    EXPECT_EQ(json["removed"], 1); // (40, 40); 8 of the target's vertices lie on the outline
    EXPECT_EQ(json["inner"], 81);
    EXPECT_EQ(json["added"], 40 - 8);
    io::TinFile const both = read(place, "both.obj");
    EXPECT_EQ(both.crs, "EPSG:32631");
    EXPECT_EQ(both.tin.vertices.size(), json["vertices"]);
    EXPECT_EQ(both.tin.triangles.size(), json["triangles"]);
    for (Vec3 const& v : both.tin.vertices) {
        EXPECT_NEAR(v.z, 50.0 + tent(v.x, v.y), 1e-6);
    }
    // Quadrilaterals of another format are cut into triangles.
    std::string land = "MESH2D\n";
    for (int i = 0; i < 36; ++i) {
        land += fmt::format("ND {} {} {} 50\n", i + 1, 20 * (i % 6), 20 * (i / 6));
    }
    for (int i = 1; i <= 29; ++i) {
        land += i % 6 == 0 ? "" : fmt::format("E4Q {0} {0} {1} {2} {3} 1\n", i, i + 1, i + 7, i + 6);
    }
    place.write("land.2dm", land);
    expect_run(place, "blend land.2dm hill.obj -o quads.obj --source-crs EPSG:32632", 0);
    EXPECT_EQ(read(place, "quads.obj").crs, "EPSG:32632");
    for (Vec3 const& v : read(place, "quads.obj").tin.vertices) {
        EXPECT_NEAR(v.z, 50.0 + tent(v.x, v.y), 1e-6);
    }
}

TEST(BlendMesh, IsMovedTurnedScaledAndRaised) {
    Workplace const place;
    write_meshes(place);
    std::string const moved = "blend land.obj hill.obj --at 61,57 --rotate 90 --scale 2 --gain 3 -o ";
    expect_run(place, moved + "both.2dm --threads 1", 0);
    expect_run(place, moved + "again.2dm --threads 2", 0);
    EXPECT_EQ(file_bytes(place / "both.2dm"), file_bytes(place / "again.2dm"));
    double highest = 0.0;
    for (Vec3 const& v : read(place, "both.2dm").tin.vertices) {
        highest = std::max(highest, v.z);
        EXPECT_NEAR(v.z, 50.0 + 3.0 * tent(40.0 + (v.x - 61.0) / 2.0, 40.0 + (v.y - 57.0) / 2.0), 1e-5);
    }
    EXPECT_NEAR(highest, 71.0, 1e-6);
    place.write("far.obj", obj(4, 5.0, {900, 900}, tent));
    auto const far = expect_run(place, "blend land.obj far.obj -o far.off --json", 0).json();
    EXPECT_EQ(far["place"], "middle");
    EXPECT_EQ(far["at"], nlohmann::json::parse("[50.0, 50.0]"));
}

TEST(BlendMesh, RefusesWhatItCannotUse) {
    Workplace const place;
    write_meshes(place);
    io::write_dem(Raster<float>(Grid{20, 20, 10.0, 0.0, 200.0, "EPSG:32631"}, 1.0F), (place / "dem.tif").string());
    place.write("abroad.obj", obj(4, 5.0, {30, 30}, tent, "EPSG:32632"));
    std::string hole = obj(3, 5.0, {30, 30}, tent);
    for (std::string const face : {"f 6 7 10\n", "f 7 11 10\n"}) {
        hole.erase(hole.find(face), face.size());
    }
    place.write("hole.obj", hole);
    place.write("upright.obj", "v 30 30 0\nv 40 30 0\nv 40 30 5\nf 1 2 3\n");
    expect_refused(place, "blend -o out.obj",
                   {"dem.tif hill.obj", "land.obj dem.tif", "land.obj none.obj", "land.obj abroad.obj",
                    "land.obj hole.obj", "land.obj upright.obj"});
    expect_refused(place, "blend land.obj hill.obj -o out.obj",
                   {"--at 95,50", "--at 950,50", "--at 95", "--scale 0", "--gain inf", "--window 0,0,2,2",
                    "--mask dem.tif", "--keep dem.tif", "--feather 3", "--mixed", "--fill-holes"});
    expect_refused(place, "blend land.obj hill.obj -o out.tif", {""});
    expect_run(place, "blend land.obj hill.obj -o out.obj", 0);
    expect_refused(place, "blend land.obj hill.obj -o out.obj", {""});
}

} // namespace blend_mesh_test
