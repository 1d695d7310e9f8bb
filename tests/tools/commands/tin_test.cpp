// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

#include "command.hpp"

namespace tin_test {

namespace fs = std::filesystem;

namespace {

/// A DEM of 5 x 4 cells with a hole in its corner and a peak.
void write_dem(Workplace const& place) {
    place.write("dem.asc", "ncols 5\nnrows 4\nxllcorner 500000\nyllcorner 4000000\ncellsize 10\nNODATA_value -9999\n"
                           "-9999 0 0 0 0\n0 0 9 0 0\n0 0 0 0 0\n0 0 0 0 0\n");
}

std::string const points = "x,y,z\n0,0,1\n10,0,2\n10,10,3\n0,10,4\n5,5,9\n";

} // namespace

TEST(Tin, OfADemWithinAnError) {
    Workplace const place;
    write_dem(place);
    auto const json = expect_run(place, "tin dem.asc -o dem.2dm --error 0.5 --json", 0).json();
    EXPECT_EQ(json["source"], "dem");
    EXPECT_LE(json["error_m"], 0.5);
    EXPECT_EQ(json["left_out"], 0);
    std::string const mesh = file_bytes(place / "dem.2dm");
    EXPECT_EQ(mesh.rfind("MESH2D\n", 0), 0U);
    EXPECT_TRUE(test::has(mesh, " 500025 4000025 9\n"));
}

TEST(Tin, OfPointsInEveryFormat) {
    Workplace const place;
    place.write("p.csv", points);
    for (std::string const name : {"a.2dm", "a.ply", "a.gpkg", "a.obj", "a.off", "a.xml", "a.las", "a.xyz"}) {
        Outcome const o = expect_run(place, "tin p.csv --crs EPSG:32631 -o " + name, 0);
        EXPECT_EQ(o.out, name + "\n");
        EXPECT_GE(fs::file_size(place / name), 34U);
    }
    EXPECT_EQ(thalweg_run("tin -q p.csv -o b.ply --format ply-points", place.path()).err, "");
    EXPECT_FALSE(test::has(file_bytes(place / "b.ply"), "element face"));
    EXPECT_EQ(std::distance(fs::directory_iterator(place.path()), {}), 10);
}

TEST(Tin, OfANetworkItsBreaklinesAndRidges) {
    Workplace const place;
    expect_run(place, small + "land --set surface.method=tin --set skeleton.ridges=voronoi", 0);
    auto const json = expect_run(place, "tin land -o a.2dm --json", 0).json();
    EXPECT_EQ(json["source"], "network");
    EXPECT_EQ(json["crs"], "EPSG:32631");
    EXPECT_EQ(json["merged_dz_m"], 0.0);
    expect_run(place, "tin land/network.gpkg -o b.2dm --threads 1", 0);
    EXPECT_EQ(file_bytes(place / "a.2dm"), file_bytes(place / "b.2dm"));
    place.write("p.csv", "300000,100000,5\n900000,100000,5\n300000,900000,5\n");
    auto const both = expect_run(place, "tin p.csv --crs EPSG:32631 --breaklines land -o c.2dm --json", 0).json();
    place.shell("ogr2ogr arcs.gpkg land/network.gpkg arcs");
    auto const arcs = expect_run(place, "tin arcs.gpkg -o d.2dm --json", 0).json();
    EXPECT_EQ(both["vertices"], arcs["vertices"].get<int>() + 3);
    EXPECT_GT(json["vertices"], arcs["vertices"].get<int>() + 20); // those of ridges
}

TEST(Tin, PointsTakeACrsColumnsAndAMeanOfDuplicates) {
    Workplace const place;
    place.write("degrees.csv", "x,y,z\n9,45,100\n9.01,45,120\n9,45.01,140\n");
    auto const zone = expect_run(place, "tin degrees.csv --source-crs EPSG:4326 -o a.2dm --json", 0).json();
    EXPECT_EQ(zone["crs"], "EPSG:32632");
    EXPECT_TRUE(test::has(file_bytes(place / "a.2dm"), " 500000 4982950.4"));

    place.write("bare.csv", "1,5000000.0,500000.0,210.5\n2,5000100.0,500900.0,180.2\n3,5000800.0,500300.0,240.1\n");
    expect_run(place, "tin bare.csv -o a.xyz --columns pnezd", 0);
    EXPECT_EQ(file_bytes(place / "a.xyz"), "500000 5000000 210.5\n500900 5000100 180.2\n500300 5000800 240.1\n");

    place.write("twice.csv", "x,y,z\n500000,5000000,210\n500900,5000100,180\n500300,5000800,240\n"
                             "500300,5000800,240.4\n500600,5000400,200\n500600,5000400,200\n");
    auto const json = expect_run(place, "tin twice.csv -o b.2dm --json", 0).json();
    EXPECT_EQ(json["vertices"], 4);
    EXPECT_EQ(json["merged"], 2);
    EXPECT_EQ(json["averaged"], 1);
    EXPECT_TRUE(test::has(file_bytes(place / "b.2dm"), " 500300 5000800 240.2\n"));
    expect_refused(
        place, "tin -o c.2dm",
        {"bare.csv", "bare.csv --columns 1,2", "twice.csv --duplicates error", "twice.csv --duplicates none"});
}

TEST(Tin, NothingIsOverwrittenUnasked) {
    Workplace const place;
    place.write("p.csv", points);
    place.write("a.2dm", "mine");
    expect_refused(place, "tin p.csv -o a.2dm", {""});
    expect_run(place, "tin p.csv -o a.2dm --overwrite", 0);
    EXPECT_EQ(file_bytes(place / "a.2dm").rfind("MESH2D\n", 0), 0U);
}

TEST(Tin, BadInputIsRefused) {
    Workplace const place;
    write_dem(place);
    place.write("p.csv", points);
    place.write("line.csv", "0,0,1\n1,1,2\n2,2,3\n");
    place.write("nan.csv", "0,0,1\n1,0,nan\n0,1,2\n");
    place.write("flat.geojson", test::geojson(test::line("[1,1],[2,3]")));
    expect_refused(place, "tin", {"", "p.csv", "p.csv -o a.dxf", "p.csv -o none/a.2dm", "p.csv -o ."});
    expect_refused(place, "tin -o a.2dm",
                   {"nowhere.tif", "line.csv", "nan.csv", "flat.geojson", "p.csv --format dxf", "p.csv --error 3",
                    "p.csv --breaklines dem.asc", "p.csv --breaklines flat.geojson", "p.csv --crs EPSG:4326",
                    "dem.asc --error 0", "dem.asc --error -2", "dem.asc --error nan", "dem.asc --error much",
                    "dem.asc --breaklines flat.geojson", "dem.asc --source-crs EPSG:32631", "dem.asc --columns pnezd",
                    "dem.asc --duplicates mean"});
}

} // namespace tin_test
