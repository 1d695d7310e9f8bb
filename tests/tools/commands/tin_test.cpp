// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <iterator>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <io/las_files.hpp>
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

    expect_run(place, "tin degrees.csv --crs EPSG:4326 -o no.2dm", 2, "--source-crs EPSG:4326");

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

TEST(Tin, OfAPointCloudByClassesAndCells) {
    Workplace const place;
    las_files::File cloud{.records = {las_files::keys({{1024, 1}, {3072, 32631}})}};
    for (int i = 0; i < 100; ++i) {
        cloud.points.push_back({{500000.5 + i % 10, 4000000.5 + i / 10, 100.0 + i % 7}, i % 2 == 0 ? 2 : 5});
    }
    place.write("cloud", las_files::bytes_of(cloud)); // known by its content
    Outcome const ground = expect_run(place, "tin cloud -o a.2dm --json", 0);
    auto const json = ground.json();
    EXPECT_EQ(json["source"], "points");
    EXPECT_EQ(json["crs"], "EPSG:32631");
    EXPECT_EQ(json["vertices"], 50);
    ASSERT_EQ(json["findings"].size(), 1U);
    EXPECT_EQ(json["findings"][0]["kind"], "cloud_classes");
    EXPECT_TRUE(test::has(ground.err, "cloud has 100 points; 50 of them, of the ground (classes 2 and 8), are taken"));
    EXPECT_EQ(expect_run(place, "tin cloud --classes all -o b.2dm --json", 0).json()["vertices"], 100);
    auto const thin = expect_run(place, "tin cloud --classes 2,5 --thin 5 -o c.2dm --json", 0).json();
    EXPECT_EQ(thin["vertices"], 4);
    EXPECT_EQ(thin["findings"][1]["kind"], "cloud_thinned");
    EXPECT_EQ(thin["findings"][1]["amount"], 5);
    expect_run(place, "tin cloud --classes grund -o d.2dm", 2, "Did you mean 'ground'?");
    place.write("p.csv", points);
    write_dem(place);
    expect_refused(place, "tin -o d.2dm",
                   {"p.csv --classes 2", "p.csv --thin 2", "dem.asc --classes 2", "dem.asc --thin 2", "cloud --thin -1",
                    "cloud --columns 1,2,3", "cloud --height-column z", "cloud --error 1"});
    place.write("scan.e57", "ASTM-E57" + std::string(40, '\0'));
    expect_run(place, "tin scan.e57 -o d.2dm", 2, "is E57", "pdal translate scan.e57 scan.las");
}

TEST(Tin, APointCloudGivesASkeletonItsPoints) {
    Workplace const place;
    las_files::File cloud{.records = {las_files::keys({{1024, 1}, {3072, 32631}})}};
    for (int i = 0; i < 64; ++i) {
        cloud.points.push_back({{500060.0 + 120.0 * (i % 8), 4998300.0 + 120.0 * (i / 8), 100.0 + 3 * (i % 7)}, 2});
    }
    cloud.points.push_back(cloud.points.back()); // two points at one place: of a cloud nobody can remove one
    cloud.points.back().at.z += 2.0;
    place.write("cloud.las", las_files::bytes_of(cloud));
    Outcome const made = expect_run(
        place,
        "make --set grid.cell=30 "
        "--set grid.width=64 --set grid.height=64 --set surface.method=diffuse --set skeleton.points=cloud.las -o out",
        0);
    EXPECT_TRUE(test::has(made.err, "cloud.las has 65 points; 65 of them, of the ground (classes 2 and 8), are taken"));
    EXPECT_TRUE(file_bytes(place / "out/inputs/points/cloud.las") == file_bytes(place / "cloud.las"));
    fs::remove(place / "cloud.las");
    expect_run(place, "replay out --verify", 0);
}

TEST(Tin, HeightsMayStandInAColumn) {
    Workplace const place;
    auto const point = [](int x, int y, double z, double quota) {
        return fmt::format(R"({{"type":"Feature","properties":{{"id":{0},"quota":{3}}},)"
                           R"("geometry":{{"type":"Point","coordinates":[{0},{1},{2}]}}}})",
                           500000 + x, 4000000 + y, z, quota);
    };
    place.write("zero.geojson",
                test::geojson(point(0, 0, 0, 195.5) + "," + point(90, 0, 0, 248.8) + "," + point(0, 90, 0, 210)));
    expect_run(place, "tin zero.geojson -o a.xyz", 2, "all heights", "--height-column id or quota");
    auto const json = expect_run(place, "tin zero.geojson --height-column QUOTA -o a.xyz --json", 0).json();
    EXPECT_EQ(json["vertices"], 3);
    EXPECT_EQ(file_bytes(place / "a.xyz"), "500000 4000000 195.5\n500090 4000000 248.8\n500000 4000090 210\n");
    expect_run(place, "tin zero.geojson --height-column quotta -o b.xyz", 2, "Did you mean 'quota'");
    place.write("text.csv", "x,y,z,quota\n0,0,0,7.5\n9,0,0,8\n0,9,0,9\n");
    expect_run(place, "tin text.csv --height-column quota -o c.xyz", 0);
    EXPECT_EQ(file_bytes(place / "c.xyz"), "0 0 7.5\n9 0 8\n0 9 9\n");
    // Contours.
    auto const contour = [](int y, int elev) {
        return fmt::format(R"({{"type":"Feature","properties":{{"elev":{1}}},)"
                           R"("geometry":{{"type":"LineString","coordinates":[[500000,{0}],[500100,{0}]]}}}})",
                           4000000 + y, elev);
    };
    place.write("contours.geojson", test::geojson(contour(0, 100) + "," + contour(50, 120)));
    expect_run(place, "tin contours.geojson -o d.xyz", 2, "no heights", "--height-column elev");
    expect_run(place, "tin contours.geojson --height-column elev -o d.xyz", 0);
    EXPECT_TRUE(test::has(file_bytes(place / "d.xyz"), "500000 4000050 120\n"));
    place.write("bend.geojson",
                test::geojson(R"({"type":"Feature","properties":{"elev":100},"geometry":)"
                              R"({"type":"LineString","coordinates":[[500000,4000000],[500100,4000000],)"
                              R"([500100,4000100]]}},)" +
                              contour(200, 120)));
    auto const bend = expect_run(place, "tin bend.geojson --height-column elev -o e.xyz --json", 0).json();
    EXPECT_NEAR(bend["flat"].get<double>(), 5000.0 / 20000.0, 1e-9);
}

TEST(Tin, FlatAreasOfContoursAreFilledInAndLakesStay) {
    Workplace const place;
    auto const ring = [](double radius, std::string const& properties, std::string const& z) {
        std::string places;
        for (int k = 0; k <= 36; ++k) {
            double const angle = 6.283185307179586 * (k % 36) / 36;
            places += fmt::format("{}[{},{}{}]", k == 0 ? "" : ",", 500000.0 + radius * std::cos(angle),
                                  4000000.0 + radius * std::sin(angle), z);
        }
        return fmt::format(R"({{"type":"Feature","properties":{{{}}},"geometry":{{"type":"LineString",)"
                           R"("coordinates":[{}]}}}})",
                           properties, places);
    };
    std::string contours;
    for (int i = 0; i < 4; ++i) {
        contours += (i == 0 ? "" : ",") + ring(400.0 - 100.0 * i, fmt::format(R"("elev":{})", 10 * i + 10), "");
    }
    place.write("hill.geojson", test::geojson(contours));
    place.write("lake.geojson", test::geojson(ring(60.0, "", ",40")));
    std::string const tin = "tin hill.geojson --height-column elev --json -o ";
    auto const flat = expect_run(place, tin + "a.2dm", 0, "--medial-points fills it in").json();
    EXPECT_GT(flat["flat"].get<double>(), 0.05);
    auto const cured = expect_run(place, tin + "b.2dm --medial-points", 0, "points are added").json();
    EXPECT_LT(cured["flat"].get<double>(), 0.002);
    EXPECT_GT(cured["medial_points"].get<int>(), 0);
    auto const lake = expect_run(place, tin + "c.2dm --medial-points --breaklines lake.geojson", 0).json();
    EXPECT_GT(lake["flat"].get<double>(), 0.01);
    place.write("points.csv", "x,y,z\n0,0,1\n9,0,2\n0,9,3\n");
    expect_refused(place, "tin points.csv -o d.2dm", {"--medial-points"});
}

TEST(Tin, PointsOfNoDataAreNoPoints) {
    Workplace const place;
    place.write("p.csv", "x,y,z\n0,0,101\n10,0,102\n10,10,-9999\n0,10,104\n5,5,109\n");
    expect_run(place, "tin p.csv -o a.xyz", 2, "1 of 5 points", "--nodata -9999 leaves them out");
    Outcome const left = expect_run(place, "tin p.csv --nodata -9999 -o a.xyz", 0);
    EXPECT_TRUE(test::has(left.err, "1 point is of no data left out") || test::has(left.err, "left out")) << left.err;
    EXPECT_EQ(file_bytes(place / "a.xyz"), "0 0 101\n10 0 102\n0 10 104\n5 5 109\n");
    expect_run(place, "tin p.csv --nodata nan -o b.xyz", 0);
    EXPECT_TRUE(test::has(file_bytes(place / "b.xyz"), "10 10 -9999\n"));
    place.write("sea.csv", "x,y,z\n0,0,-9800\n10,0,-9900\n10,10,-9999\n0,10,-10050\n");
    expect_run(place, "tin sea.csv -o c.xyz", 0);
    // In skeleton.points too, where no option can keep them.
    expect_run(place,
               "make --set grid.width=160 --set grid.height=128 --set grid.cell=30 --set surface.method=diffuse "
               "--set skeleton.points=p.csv -o out",
               2, "-9999", "--set skeleton.nodata=-9999 leaves them out");
}

TEST(Tin, ShoresAreLevelBreaklines) {
    Workplace const place;
    place.write("p.csv", "x,y,z\n500000,4000000,101\n500100,4000000,102\n500100,4000100,103\n500000,4000100,104\n");
    auto const shore = [](std::string const& z) {
        return test::geojson(test::line("[500040,4000040" + z + "],[500060,4000040" + z + "],[500050,4000060" + z +
                                        "],[500040,4000040" + z + "]"));
    };
    place.write("shore.geojson", shore(",100.25"));
    auto const json =
        expect_run(place, "tin p.csv --crs EPSG:32631 --breaklines shore.geojson -o a.xyz --json", 0).json();
    EXPECT_EQ(json["vertices"], 7);
    EXPECT_TRUE(test::has(file_bytes(place / "a.xyz"), "500050 4000060 100.25\n"));
    std::string polygon = shore(",100.25"); // the same as a polygon
    polygon.replace(polygon.find("LineString"), 10, "Polygon");
    polygon.replace(polygon.find("[["), 2, "[[[");
    polygon.replace(polygon.find("]]"), 2, "]]]");
    place.write("lake.geojson", polygon);
    expect_run(place, "tin p.csv --crs EPSG:32631 --breaklines lake.geojson -o lake.xyz", 0);
    EXPECT_EQ(file_bytes(place / "lake.xyz"), file_bytes(place / "a.xyz"));
    place.shell("ogr2ogr lake.gpkg lake.geojson -nlt POLYGONZ");
    expect_run(place, "tin p.csv --crs EPSG:32631 --breaklines lake.gpkg -o gpkg.xyz", 0);
    EXPECT_EQ(file_bytes(place / "gpkg.xyz"), file_bytes(place / "a.xyz"));
    for (char const* const none : {"", ",0"}) {
        place.write("none.geojson", shore(none));
        expect_run(place, "tin p.csv --crs EPSG:32631 --breaklines none.geojson -o b.xyz", 2, "no heights");
    }
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
