// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Opening a pipe waits until someone writes to it: as an input it is refused, by its own name or another file's.
#include <string>
#include <sys/stat.h>
#include <vector>

#include <gtest/gtest.h>
#include <support.hpp>

#include "command.hpp"
#include "spawned.hpp"

namespace pipes_test {

namespace fs = std::filesystem;

namespace {

using Words = std::vector<std::string>;

class Pipes : public MadeOnce {
protected:
    static void SetUpTestSuite() {
        MadeOnce::SetUpTestSuite();
        place().write("region.geojson", test::geojson(test::feature("Polygon", "[[[0,0],[9,0],[9,9],[0,0]]]")));
        place().write("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        place().write("points.csv", "x,y,z\n0,0,1\n9,0,2\n0,9,3\n");
        fs::create_directory(place() / "folder");
        for (std::string const name : {"p.toml", "p.gpkg", "p.tif", "p.csv", "p.obj", "p.geojson", "p.shp", "p.zip",
                                       "folder/dem.tif", "folder/network.gpkg", "folder/recipe.toml"}) {
            ASSERT_EQ(mkfifo((place() / name).c_str(), 0600), 0);
        }
    }
    static void expect_refused_pipe(Words const& words) {
        std::string line;
        for (std::string const& word : words) {
            line += word + " ";
        }
        Ended const ended = spawn(words, place().path());
        EXPECT_EQ(ended.code, 2) << line << ended.err;
        EXPECT_TRUE(test::has(ended.err, "a pipe or a device")) << line;
        EXPECT_FALSE(fs::exists(place() / "out")) << line;
    }
};

Words make_with(std::string const& key, std::string const& file, Words const& more = {}) {
    Words words = small_make();
    words.insert(words.end(), {"--set", key + "=" + file});
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

} // namespace

TEST_F(Pipes, AreRefusedAsTheInputOfEveryCommand) {
    for (Words const& words :
         std::vector<Words>{{"make", "p.toml", "-o", "out"},
                            {"make", "p.gpkg", "-o", "out"},
                            {"make", "p.zip", "-o", "out"},
                            {"make", "folder", "-o", "out"},
                            {"check", "p.gpkg"},
                            {"check", "p.shp"},
                            {"check", "p.zip"},
                            {"check", "folder"},
                            {"check", "base", "--dem", "p.tif"},
                            {"convert", "p.gpkg", "-o", "out.gpkg"},
                            {"convert", "base", "--dem", "p.tif", "-o", "out.gpkg"},
                            {"stats", "p.tif"},
                            {"stats", "p.zip"},
                            {"measure", "p.tif", "-o", "out"},
                            {"measure", "base/dem.tif", "p.gpkg", "-o", "out"},
                            {"measure", "folder", "-o", "out"},
                            {"draw", "p.tif", "-o", "out"},
                            {"draw", "folder", "-o", "out"},
                            {"draw", "base/dem.tif", "--network", "p.gpkg", "-o", "out"},
                            {"export", "p.tif", "-o", "out.glb"},
                            {"export", "folder", "-o", "out.glb"},
                            {"tin", "p.tif", "-o", "out.ply"},
                            {"tin", "p.csv", "-o", "out.ply"},
                            {"tin", "folder", "-o", "out.ply"},
                            {"tin", "points.csv", "--breaklines", "p.gpkg", "-o", "out.ply"},
                            {"points", "p.tif", "-o", "out.las"},
                            {"points", "folder", "-o", "out.las"},
                            {"blend", "p.tif", "base/dem.tif", "-o", "out.tif"},
                            {"blend", "base/dem.tif", "p.tif", "-o", "out.tif"},
                            {"blend", "base/dem.tif", "base/dem.tif", "--mask", "p.tif", "-o", "out.tif"},
                            {"blend", "base/dem.tif", "base/dem.tif", "--keep", "p.gpkg", "-o", "out.tif"},
                            {"blend", "p.obj", "mesh.obj", "-o", "out.obj"},
                            {"deform", "p.tif", "--mask", "region.geojson", "--scale", "2", "-o", "out.tif"},
                            {"deform", "base/dem.tif", "--mask", "p.tif", "--scale", "2", "-o", "out.tif"},
                            {"deform", "base/dem.tif", "--mask", "p.geojson", "--scale", "2", "-o", "out.tif"},
                            {"deform", "p.obj", "--mask", "region.geojson", "--scale", "2", "-o", "out.obj"},
                            {"grow", "--lsystem", "--rules", "p.toml"},
                            {"replay", "folder"},
                            {"recipe", "--for", "p.gpkg"}}) {
        expect_refused_pipe(words);
    }
}

TEST_F(Pipes, AreRefusedAsTheFilesOfARecipe) {
    expect_refused_pipe(make_with("surface.mask", "p.tif", {"--set", "surface.method=dilate"}));
    expect_refused_pipe(make_with("surface.uplift", "p.tif"));
    expect_refused_pipe(make_with("surface.lakes", "p.geojson"));
    expect_refused_pipe(make_with("skeleton.points", "p.csv", {"--set", "surface.method=diffuse"}));
    expect_refused_pipe({"make", "-o", "out", "--set", "network.source=lines", "--set", "network.lines.path=p.gpkg"});
    place().write("lines.toml", "[network]\nsource = \"lines\"\n[network.lines]\npath = \"p.gpkg\"\n[surface]\n");
    expect_refused_pipe({"make", "lines.toml", "-o", "out"});
    expect_refused_pipe(
        {"make", "-o", "out", "--set", "network.source=tokunaga", "--set", "network.tokunaga.strokes=p.geojson"});
    expect_refused_pipe(
        {"make", "-o", "out", "--set", "network.source=forest", "--set", "network.forest.region=p.geojson"});
    expect_refused_pipe(make_with("patch.1.source", "p.tif"));
}

TEST_F(Pipes, AreRefusedBesideAFileAndWhereAnotherNamesThem) {
    for (std::string const ending : {"shp", "shx", "dbf", "prj"}) {
        fs::copy_file(place() / ("base/network_arcs." + ending), place() / ("lines." + ending));
    }
    place().write("lines.toml", "[network]\nsource = \"lines\"\n[network.lines]\npath = \"lines.shp\"\n[surface]\n");
    for (std::string const ending : {"dbf", "prj"}) {
        fs::path const part = place() / ("lines." + ending);
        fs::rename(part, place() / "aside");
        ASSERT_EQ(mkfifo(part.c_str(), 0600), 0);
        expect_refused_pipe({"check", "lines.shp"});
        expect_refused_pipe({"make", "lines.shp", "-o", "out"});
        expect_refused_pipe({"make", "lines.toml", "-o", "out"});
        fs::remove(part);
        fs::rename(place() / "aside", part);
    }
    for (std::string const ending : {"-journal", "-wal"}) {
        fs::path const beside = place() / ("base/network.gpkg" + ending);
        ASSERT_EQ(mkfifo(beside.c_str(), 0600), 0);
        expect_refused_pipe({"check", "base/network.gpkg"});
        EXPECT_TRUE(fs::remove(beside)) << "it is not ours";
    }
    place().write("land.vrt",
                  "<VRTDataset rasterXSize='9' rasterYSize='9'><GeoTransform>0,9,0,0,0,-9</GeoTransform><VRTRasterBand "
                  "dataType='Float32' band='1'><SimpleSource><SourceFilename relativeToVRT='1'>p.tif</SourceFilename>"
                  "<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>");
    expect_refused_pipe({"stats", "land.vrt"});
    expect_refused_pipe({"draw", "land.vrt", "-o", "out"});
}

} // namespace pipes_test
