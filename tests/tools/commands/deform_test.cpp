// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/io/mesh/tin.hpp>
#include <thalweg/io/raster/raster_files.hpp>

#include "command.hpp"

namespace deform_test {

namespace {

using namespace thalweg;

Grid const frame{40, 30, 10.0, 500000.0, 4000000.0, "EPSG:32631"};

/// A slope to the east with waves, and the cells 10 to 29, 8 to 21 as a region.
void write_lands(Workplace const& place) {
    Raster<float> dem(frame);
    Raster<float> region(frame);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Cell const c = frame.at(i);
        dem[i] = static_cast<float>(2 * c.col + (c.col * 7 + c.row * 5) % 11);
        region[i] = c.col >= 10 && c.col < 30 && c.row >= 8 && c.row < 22 ? 1.0F : 0.0F;
    }
    io::write_dem(dem, (place / "land.tif").string());
    io::write_dem(region, (place / "region.tif").string());
}

} // namespace

TEST(Deform, PullsAPlaceToItsHeightAndKeepsWhatIsOutside) {
    Workplace const place;
    write_lands(place);
    auto const json =
        expect_run(place, "deform land.tif -o bent.tif --mask region.tif --pull 500205,3999845,500 --json", 0).json();
    EXPECT_EQ(json["cells"], 280);
    EXPECT_EQ(json["handles"], 1);
    Raster<float> const before = io::read_dem((place / "land.tif").string());
    Raster<float> const after = io::read_dem((place / "bent.tif").string());
    EXPECT_EQ(after[(Cell{20, 15})], 500.0F);
    std::int64_t changed = 0;
    for (std::int64_t i = 0; i < before.cells(); ++i) {
        Cell const c = frame.at(i);
        bool const inside = c.col >= 10 && c.col < 30 && c.row >= 8 && c.row < 22;
        if (!inside) {
            EXPECT_EQ(after[i], before[i]);
        }
        changed += after[i] != before[i];
    }
    EXPECT_GT(changed, 200);
}

TEST(Deform, ScaleZeroTakesTheRegionsReliefAway) {
    Workplace const place;
    write_lands(place);
    expect_run(place, "deform land.tif -o flat.tif --mask region.tif --scale 0", 0);
    Raster<float> const dem = io::read_dem((place / "flat.tif").string());
    Cell const c{20, 15};
    double const around =
        0.25 * (static_cast<double>(dem[Cell{19, 15}]) + dem[Cell{21, 15}] + dem[Cell{20, 14}] + dem[Cell{20, 16}]);
    EXPECT_NEAR(dem[c], around, 1e-4); // harmonic
}

TEST(Deform, BadInputIsRefused) {
    Workplace const place;
    write_lands(place);
    expect_refused(place, "deform land.tif -o x.tif --mask",
                   {"region.tif", "region.tif --pull 1,2,3", "region.tif --pull 500005,3999995,3",
                    "region.tif --pull 500205,3999845", "none.tif --scale 2", "region.tif --scale nan",
                    "region.tif --rotate 5", "region.tif --scale 2 --source-crs EPSG:32631"});
}

TEST(Deform, RotatesAPartOfAMeshOutOfThePlane) {
    Workplace const place;
    std::string obj = "# crs EPSG:32631\n";
    for (int row = 0; row < 9; ++row) {
        for (int col = 0; col < 9; ++col) {
            obj += "v " + std::to_string(10 * col) + " " + std::to_string(10 * row) + " 5\n";
        }
    }
    for (int row = 0; row < 8; ++row) {
        for (int col = 0; col < 8; ++col) {
            int const sw = 9 * row + col + 1;
            obj += "f " + std::to_string(sw) + " " + std::to_string(sw + 1) + " " + std::to_string(sw + 10) + "\n";
            obj +=
                "f " + std::to_string(sw) + "/1/1 " + std::to_string(sw + 10) + "/2 " + std::to_string(sw + 9) + "\n";
        }
    }
    place.write("mesh.obj", obj);
    place.write("region.geojson",
                test::geojson(test::feature("Polygon", "[[[15,15],[65,15],[65,65],[15,65],[15,15]]]")));
    auto const heights = [&](std::string const& name) { return io::read_tin((place / name).string()).tin.vertices; };
    expect_run(place, "deform mesh.obj -o turned.obj --mask region.geojson --rotate 40 --axis 1,0,0", 0);
    std::vector<Vec3> const before = heights("mesh.obj");
    std::vector<Vec3> const turned = heights("turned.obj");
    ASSERT_EQ(turned.size(), before.size());
    double most = 0.0;
    double least = 0.0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        bool const inside = before[i].x > 15 && before[i].x < 65 && before[i].y > 15 && before[i].y < 65;
        EXPECT_TRUE(inside || turned[i] == before[i]) << i;
        most = std::max(most, turned[i].z - 5.0);
        least = std::min(least, turned[i].z - 5.0);
    }
    EXPECT_GT(most, 1.0); // one half rises about the axis, the other sinks as far
    EXPECT_NEAR(most, -least, 1e-6 * most);
    EXPECT_GT(turned[9 * 6 + 4].z, 5.0); // counterclockwise about the east: the north rises
    EXPECT_LT(turned[9 * 2 + 4].z, 5.0);

    Outcome const pulled =
        expect_run(place, "deform mesh.obj -o pulled.off --mask region.geojson --pull 40,40,25 --json", 0);
    EXPECT_EQ(pulled.json()["vertices"], 25);
    std::vector<Vec3> const tent = heights("pulled.off");
    EXPECT_EQ(tent[9 * 4 + 4].z, 25.0);
    for (std::size_t i = 0; i < before.size(); ++i) {
        EXPECT_EQ(tent[i].x, before[i].x);
        EXPECT_GE(tent[i].z, 5.0 - 1e-9);
    }
    obj.erase(0, obj.find('\n') + 1); // without its CRS it has the mask's
    place.write("bare.obj", obj);
    expect_run(place, "deform bare.obj -o bare_pulled.obj --mask region.geojson --pull 40,40,25", 0);
    EXPECT_EQ(heights("bare_pulled.obj"), tent);

    place.write("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 nan\nf 1 2 3\n"); // others: ReadTin
    expect_refused(place, "deform --mask region.geojson",
                   {"bad.obj -o out.obj --scale 2", "mesh.obj -o out.obj", "mesh.obj -o out.obj --rotate 5 --axis 1,2",
                    "mesh.obj -o out.obj --rotate 5 --axis 0,0,0", "mesh.obj -o out.txt --rotate 5"});
}

} // namespace deform_test
