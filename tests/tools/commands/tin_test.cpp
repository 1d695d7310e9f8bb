// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <support.hpp>

#include "command.hpp"
#include "refused.hpp"

namespace tin_test {

namespace fs = std::filesystem;

namespace {

void refused(Workplace const& place, std::string const& arguments, std::string const& words) {
    expect_refused(place, "tin " + arguments, words);
}

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
    Outcome const o = expect_run(place, "tin dem.asc -o dem.2dm --error 0.5 --json", 0);
    auto const json = nlohmann::json::parse(o.out);
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
        EXPECT_TRUE(test::has(o.err, "5 vertices, 4 triangles"));
        EXPECT_GE(fs::file_size(place / name), 34U);
    }
    EXPECT_EQ(thalweg_run("tin -q p.csv -o b.ply --format ply-points", place.path()).err, "");
    EXPECT_FALSE(test::has(file_bytes(place / "b.ply"), "element face"));
    EXPECT_EQ(std::distance(fs::directory_iterator(place.path()), {}), 10);
}

TEST(Tin, OfANetworkAndItsBreaklines) {
    Workplace const place;
    ASSERT_EQ(thalweg_run("make -q --set grid.width=64 --set grid.height=64 --set network.dla.particles=400 "
                          "--set network.prune=4 -o land",
                          place.path())
                  .code,
              0);
    Outcome const folder = expect_run(place, "tin land -o a.2dm --json", 0);
    auto const json = nlohmann::json::parse(folder.out);
    EXPECT_EQ(json["source"], "network");
    EXPECT_EQ(json["crs"], "EPSG:32631");
    EXPECT_EQ(json["merged_dz_m"], 0.0);
    ASSERT_EQ(thalweg_run("tin land/network.gpkg -o b.2dm --threads 1", place.path()).code, 0);
    EXPECT_EQ(file_bytes(place / "a.2dm"), file_bytes(place / "b.2dm"));
    place.write("p.csv", "300000,100000,5\n900000,100000,5\n300000,900000,5\n");
    Outcome const both = expect_run(place, "tin p.csv --crs EPSG:32631 --breaklines land -o c.2dm --json", 0);
    EXPECT_EQ(nlohmann::json::parse(both.out)["vertices"], json["vertices"].get<int>() + 3);
}

TEST(Tin, OfAFolderKeepsItsRidges) {
    Workplace const place;
    ASSERT_EQ(thalweg_run("make -q --set grid.width=64 --set grid.height=64 --set network.dla.particles=400 "
                          "--set network.prune=4 --set surface.method=tin --set skeleton.ridges=voronoi -o land",
                          place.path())
                  .code,
              0);
    Outcome const all = expect_run(place, "tin land -o a.2dm --json", 0);
    ASSERT_EQ(std::system(("cd '" + place.path().string() + "' && ogr2ogr arcs.gpkg land/network.gpkg arcs").c_str()),
              0);
    Outcome const arcs = expect_run(place, "tin arcs.gpkg -o b.2dm --json", 0);
    EXPECT_GT(nlohmann::json::parse(all.out)["vertices"].get<int>(),
              nlohmann::json::parse(arcs.out)["vertices"].get<int>() + 20);
}

TEST(Tin, TheCrsOfPointsCanBeNamed) {
    Workplace const place;
    place.write("p.csv", "x,y,z\n9,45,100\n9.01,45,120\n9,45.01,140\n");
    Outcome const o = expect_run(place, "tin p.csv --source-crs EPSG:4326 -o a.2dm --json", 0);
    EXPECT_EQ(nlohmann::json::parse(o.out)["crs"], "EPSG:32632");
    EXPECT_TRUE(test::has(file_bytes(place / "a.2dm"), " 500000 4982950.4"));
}

TEST(Tin, ColumnsOfPointsCanBeNamed) {
    Workplace const place;
    place.write("p.csv", "1,5000000.0,500000.0,210.5\n2,5000100.0,500900.0,180.2\n3,5000800.0,500300.0,240.1\n");
    refused(place, "p.csv -o a.xyz", "p.csv, line 1: 4 columns without names");
    ASSERT_EQ(thalweg_run("tin p.csv -o a.xyz --columns pnezd", place.path()).code, 0);
    EXPECT_EQ(file_bytes(place / "a.xyz"), "500000 5000000 210.5\n500900 5000100 180.2\n500300 5000800 240.1\n");
    refused(place, "p.csv -o b.xyz --columns 1,2", "'1,2' does not name the columns of x, y and z");
    write_dem(place);
    refused(place, "dem.asc -o b.2dm --columns pnezd", "--columns applies to text with points");
}

TEST(Tin, DuplicatePointsTakeTheirMean) {
    Workplace const place;
    place.write("p.csv", "x,y,z\n500000,5000000,210\n500900,5000100,180\n500300,5000800,240\n500300,5000800,240.4\n"
                         "500600,5000400,200\n500600,5000400,200\n");
    Outcome const o = expect_run(place, "tin p.csv -o a.2dm --json", 0);
    EXPECT_TRUE(test::has(o.err, "2 duplicate points are merged"));
    auto const json = nlohmann::json::parse(o.out);
    EXPECT_EQ(json["vertices"], 4);
    EXPECT_EQ(json["merged"], 2);
    EXPECT_EQ(json["averaged"], 1);
    EXPECT_TRUE(test::has(file_bytes(place / "a.2dm"), " 500300 5000800 240.2\n"));
    refused(place, "p.csv -o b.2dm --duplicates error", "points 3 and 4 of p.csv lie both at");
    refused(place, "p.csv -o b.2dm --duplicates none", "--duplicates");
    write_dem(place);
    refused(place, "dem.asc -o b.2dm --duplicates mean", "--duplicates applies to points only");
}

TEST(Tin, NothingIsOverwrittenUnasked) {
    Workplace const place;
    place.write("p.csv", points);
    place.write("a.2dm", "mine");
    refused(place, "p.csv -o a.2dm", "a.2dm already exists");
    EXPECT_EQ(file_bytes(place / "a.2dm"), "mine");
    EXPECT_EQ(thalweg_run("tin p.csv -o a.2dm --overwrite", place.path()).code, 0);
    EXPECT_EQ(file_bytes(place / "a.2dm").rfind("MESH2D\n", 0), 0U);
}

TEST(Tin, BadInputIsRefused) {
    Workplace const place;
    write_dem(place);
    place.write("p.csv", points);
    place.write("line.csv", "0,0,1\n1,1,2\n2,2,3\n");
    place.write("two.csv", "0,0,1\n1,1,2\n");
    place.write("nan.csv", "0,0,1\n1,0,nan\n0,1,2\n");
    place.write("word.csv", "0,0,1\n1,0,low\n0,1,2\n");
    place.write("flat.geojson", R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},)"
                                R"("geometry":{"type":"LineString","coordinates":[[1,1],[2,3]]}}]})");
    refused(place, "", "SOURCE");
    refused(place, "p.csv", "--output");
    refused(place, "nowhere.tif -o a.2dm", "nowhere.tif does not exist");
    refused(place, "p.csv -o a.dxf", "does not tell the format");
    refused(place, "p.csv -o a.2dm --format dxf", "'dxf' is not a format");
    refused(place, "p.csv -o none/a.2dm", "there is no folder none");
    refused(place, "p.csv -o .", "");
    refused(place, "line.csv -o a.2dm", "3 points lie on one line, from (0, 0) to (2, 2)");
    refused(place, "two.csv -o a.2dm", "2 points in 2 different places");
    refused(place, "nan.csv -o a.2dm", "nan.csv, line 2: z is 'nan'");
    refused(place, "word.csv -o a.2dm", "word.csv, line 2: z is 'low'");
    refused(place, "dem.asc -o a.2dm --error 0", "error is 0 m");
    refused(place, "dem.asc -o a.2dm --error -2", "error is -2 m");
    refused(place, "dem.asc -o a.2dm --error nan", "greater than 0");
    refused(place, "dem.asc -o a.2dm --error much", "--error");
    refused(place, "dem.asc -o a.2dm --breaklines flat.geojson", "not to a DEM");
    refused(place, "dem.asc -o a.2dm --source-crs EPSG:32631", "not to a DEM");
    refused(place, "p.csv -o a.2dm --error 3", "--error applies to a DEM only");
    refused(place, "p.csv -o a.2dm --breaklines dem.asc", "holds no lines");
    refused(place, "p.csv -o a.2dm --breaklines flat.geojson", "have no heights");
    refused(place, "flat.geojson -o a.2dm", "have no heights");
    refused(place, "p.csv -o a.2dm --crs EPSG:4326", "4326");
}

} // namespace tin_test
