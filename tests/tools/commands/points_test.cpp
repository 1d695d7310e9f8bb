// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <io/point_files.hpp>
#include <support.hpp>

#include "command.hpp"

namespace points_test {

namespace fs = std::filesystem;

namespace {

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
        expect_run(place, "points dem.asc -o few.txt --format xyz --every 2 --json -q --threads 1", 0);
    EXPECT_EQ(thinned.err, "");
    EXPECT_EQ(thinned.json()["points"], 5);
    EXPECT_EQ(file_bytes(place / "few.txt"), "500025 4000035 0\n500045 4000035 0\n500005 4000015 0\n500025 4000015 0\n"
                                             "500045 4000015 0\n");
}

TEST(Points, OfAFolderAllCellsOrTheRivers) {
    Workplace const place;
    expect_run(place, small + "land", 0);
    auto const json = expect_run(place, "points land -o all.xyz --json", 0).json();
    EXPECT_EQ(json["crs"], "EPSG:32631");
    EXPECT_EQ(json["file"], "all.xyz");
    std::map<std::pair<double, double>, double> land;
    for (thalweg::Vec3 const& p : point_files::read_xyz(file_bytes(place / "all.xyz"))) {
        land[{p.x, p.y}] = p.z;
    }
    EXPECT_EQ(json["points"], land.size());
    EXPECT_EQ(land.size(), 64U * 48U);
    expect_run(place, "points land/network.tif -o mask.xyz", 0);
    std::vector<thalweg::Vec3> wanted;
    for (thalweg::Vec3 const& p : point_files::read_xyz(file_bytes(place / "mask.xyz"))) {
        if (p.z > 0.0) {
            wanted.push_back({p.x, p.y, land.at({p.x, p.y})});
        }
    }
    ASSERT_GT(wanted.size(), 10U);
    expect_run(place, "points land -o rivers.xyz --skeleton", 0);
    EXPECT_EQ(point_files::read_xyz(file_bytes(place / "rivers.xyz")), wanted);
    expect_run(place, "points land -o rivers.las --skeleton", 0);
    auto const las = point_files::read_las(file_bytes(place / "rivers.las"));
    EXPECT_EQ(las.points.size(), wanted.size());
    EXPECT_EQ(las.classes, std::vector<int>(wanted.size(), 9));
    EXPECT_EQ(las.epsg, 32631);
    fs::rename(place / "land/dem.tif", place / "dem.tif");
    expect_refused(place, "points land -o a.las", {""});
    fs::rename(place / "dem.tif", place / "land/dem.tif");
    fs::remove(place / "land/network.tif");
    expect_refused(place, "points land -o a.las --skeleton", {""});
}

TEST(Points, BadInputIsRefusedAndNothingOverwritten) {
    Workplace const place;
    write_dem(place);
    place.write("degrees.asc", "ncols 2\nnrows 1\nxllcorner 5\nyllcorner 50\ncellsize 0.01\nNODATA_value -9999\n1 2\n");
    place.write("degrees.prj", "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563]],"
                               "PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]]");
    fs::create_directory(place / "nothing");
    place.write("mine.xyz", "mine");
    expect_refused(place, "points",
                   {"", "dem.asc", "dem.asc -o a.laz", "dem.asc -o none/a.las", "dem.asc -o mine.xyz"});
    expect_refused(place, "points -o a.las",
                   {"nowhere.tif", "nothing", "dem.asc --format e57", "dem.asc --every 0", "dem.asc --every some",
                    "dem.asc --skeleton", "degrees.asc"});
    expect_run(place, "points dem.asc -o mine.xyz --overwrite", 0);
    EXPECT_EQ(point_files::read_xyz(file_bytes(place / "mine.xyz")).size(), 19U);
}

TEST(Points, SkeletonsHaveTheirRidgesToo) {
    Workplace const place;
    expect_run(place,
               "make " + samples +
                   "tokunaga.toml -o land -q --set grid.width=128 --set grid.height=128 "
                   "--set network.tokunaga.order=3",
               0);
    expect_run(place, "points land -o skeleton.las --skeleton", 0);
    auto const las = point_files::read_las(file_bytes(place / "skeleton.las"));
    EXPECT_GT(std::count(las.classes.begin(), las.classes.end(), 9), 100);
    EXPECT_GT(std::count(las.classes.begin(), las.classes.end(), 8), 100);
}

} // namespace points_test
