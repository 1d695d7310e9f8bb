// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <iterator>
#include <map>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <io/point_files.hpp>
#include <nlohmann/json.hpp>
#include <support.hpp>

#include "command.hpp"
#include "refused.hpp"

namespace points_test {

namespace fs = std::filesystem;

namespace {

void refused(Workplace const& place, std::string const& arguments, std::string const& words) {
    expect_refused(place, "points " + arguments, words);
}

/// A DEM of 5 x 4 cells with a hole in its corner and a peak.
void write_dem(Workplace const& place) {
    place.write("dem.asc", "ncols 5\nnrows 4\nxllcorner 500000\nyllcorner 4000000\ncellsize 10\nNODATA_value -9999\n"
                           "-9999 0 0 0 0\n0 0 9.5 0 0\n0 0 0 0 0\n0 0 0 0 0\n");
}

} // namespace

TEST(Points, OfADemInEveryFormat) {
    Workplace const place;
    write_dem(place);
    for (std::string const name : {"a.las", "a.ply", "a.xyz"}) {
        Outcome const o = expect_run(place, "points dem.asc -o " + name, 0);
        EXPECT_EQ(o.out, name + "\n");
        EXPECT_TRUE(test::has(o.err, "points     19"));
    }
    auto const xyz = point_files::read_xyz(file_bytes(place / "a.xyz"));
    ASSERT_EQ(xyz.size(), 19U);
    EXPECT_EQ(xyz.front(), (thalweg::Vec3{500015.0, 4000035.0, 0.0}));
    EXPECT_EQ(xyz[6], (thalweg::Vec3{500025.0, 4000025.0, 9.5}));
    EXPECT_EQ(point_files::read_ply(file_bytes(place / "a.ply")).vertices, xyz);
    auto const las = point_files::read_las(file_bytes(place / "a.las"));
    ASSERT_EQ(las.points.size(), 19U);
    EXPECT_NEAR(las.points[6].z, 9.5, 0.0005);
    EXPECT_EQ(las.classes, std::vector<int>(19, 2));
    Outcome const thinned =
        thalweg_run("points dem.asc -o few.txt --format xyz --every 2 --json -q --threads 1", place.path());
    ASSERT_EQ(thinned.code, 0) << thinned.err;
    EXPECT_EQ(thinned.err, "");
    EXPECT_EQ(nlohmann::json::parse(thinned.out)["points"], 5);
    EXPECT_EQ(file_bytes(place / "few.txt"), "500025 4000035 0\n500045 4000035 0\n500005 4000015 0\n500025 4000015 0\n"
                                             "500045 4000015 0\n");
}

TEST(Points, OfAFolderAllCellsOrTheRivers) {
    Workplace const place;
    ASSERT_EQ(thalweg_run("make -q --set grid.width=64 --set grid.height=64 --set network.dla.particles=400 "
                          "--set network.prune=4 -o land",
                          place.path())
                  .code,
              0);
    Outcome const all = expect_run(place, "points land -o all.xyz --json", 0);
    auto const json = nlohmann::json::parse(all.out);
    EXPECT_EQ(json["crs"], "EPSG:32631");
    EXPECT_EQ(json["file"], "all.xyz");
    std::map<std::pair<double, double>, double> land;
    for (thalweg::Vec3 const& p : point_files::read_xyz(file_bytes(place / "all.xyz"))) {
        land[{p.x, p.y}] = p.z;
    }
    EXPECT_EQ(json["points"], land.size());
    EXPECT_EQ(land.size(), 64U * 64U);
    ASSERT_EQ(thalweg_run("points land/network.tif -o mask.xyz", place.path()).code, 0);
    std::vector<thalweg::Vec3> wanted;
    for (thalweg::Vec3 const& p : point_files::read_xyz(file_bytes(place / "mask.xyz"))) {
        if (p.z > 0.0) {
            wanted.push_back({p.x, p.y, land.at({p.x, p.y})});
        }
    }
    ASSERT_GT(wanted.size(), 10U);
    ASSERT_EQ(thalweg_run("points land -o rivers.xyz --skeleton", place.path()).code, 0);
    EXPECT_EQ(point_files::read_xyz(file_bytes(place / "rivers.xyz")), wanted);
    ASSERT_EQ(thalweg_run("points land -o rivers.las --skeleton", place.path()).code, 0);
    auto const las = point_files::read_las(file_bytes(place / "rivers.las"));
    EXPECT_EQ(las.points.size(), wanted.size());
    EXPECT_EQ(las.classes, std::vector<int>(wanted.size(), 9));
    EXPECT_EQ(las.epsg, 32631);
    fs::copy_file(place / "land/network.tif", place / "network.tif");
    fs::create_directory(place / "half");
    fs::rename(place / "network.tif", place / "half/network.tif");
    refused(place, "half -o a.las", "half/dem.tif");
    fs::remove(place / "land/network.tif");
    refused(place, "land -o a.las --skeleton", "land/network.tif");
}

TEST(Points, NothingIsOverwrittenUnasked) {
    Workplace const place;
    write_dem(place);
    place.write("a.xyz", "mine");
    refused(place, "dem.asc -o a.xyz", "a.xyz already exists");
    EXPECT_EQ(file_bytes(place / "a.xyz"), "mine");
    EXPECT_EQ(thalweg_run("points dem.asc -o a.xyz --overwrite", place.path()).code, 0);
    EXPECT_EQ(point_files::read_xyz(file_bytes(place / "a.xyz")).size(), 19U);
}

TEST(Points, BadInputIsRefused) {
    Workplace const place;
    write_dem(place);
    place.write("empty.asc", "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n"
                             "-9999 -9999\n");
    place.write("degrees.asc", "ncols 2\nnrows 1\nxllcorner 5\nyllcorner 50\ncellsize 0.01\nNODATA_value -9999\n1 2\n");
    place.write("degrees.prj", "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563]],"
                               "PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]]");
    fs::create_directory(place / "nothing");
    refused(place, "", "SOURCE");
    refused(place, "dem.asc", "--output");
    refused(place, "nowhere.tif -o a.las", "nowhere.tif does not exist");
    refused(place, "nothing -o a.las", "nothing/dem.tif");
    refused(place, "dem.asc -o a.laz", "does not tell the format");
    refused(place, "dem.asc -o a.las --format e57", "'e57' is not a format");
    refused(place, "dem.asc -o none/a.las", "there is no folder none");
    refused(place, "dem.asc -o a.las --every 0", "--every");
    refused(place, "dem.asc -o a.las --every some", "--every");
    refused(place, "dem.asc -o a.las --skeleton", "--skeleton needs a folder written by make");
    refused(place, "empty.asc -o a.las", "empty.asc");
    refused(place, "degrees.asc -o a.las", "the coordinates of degrees.asc are geographic");
}

TEST(Points, SkeletonsHaveTheirRidgesToo) {
    Workplace const place;
    std::string const recipe = THALWEG_SOURCE_DIR "/samples/tokunaga.toml";
    ASSERT_EQ(thalweg_run("make " + recipe +
                              " -o land -q --set grid.width=128 --set grid.height=128 --set network.tokunaga.order=3",
                          place.path())
                  .code,
              0);
    ASSERT_EQ(thalweg_run("points land -o skeleton.las --skeleton", place.path()).code, 0);
    auto const las = point_files::read_las(file_bytes(place / "skeleton.las"));
    EXPECT_GT(std::count(las.classes.begin(), las.classes.end(), 9), 100);
    EXPECT_GT(std::count(las.classes.begin(), las.classes.end(), 8), 100);
}

} // namespace points_test
