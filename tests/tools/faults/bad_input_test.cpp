// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdlib>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

#include "command.hpp"
#include "refused.hpp"

namespace bad_input_test {

namespace fs = std::filesystem;

namespace {

using test::geojson;

std::string const small = "make --set grid.width=64 --set grid.height=64 --set network.dla.particles=400 "
                          "--set network.prune=4 -o out ";

std::string river(int id, std::string const& coordinates) {
    return R"({"type":"Feature","id":)" + std::to_string(id) +
           R"(,"properties":{"a":1},"geometry":{"type":"LineString","coordinates":[)" + coordinates + "]}}";
}

std::string lines_recipe(std::string const& path, std::string const& more = "") {
    return "[grid]\ncell = 10\n[network]\nsource = \"lines\"\n[network.lines]\npath = \"" + path + "\"\n" + more +
           "[surface]\n";
}

} // namespace

TEST(BadInput, CommandLine) {
    Workplace const place;
    expect_refused(place, "mak", "thalweg has no command 'mak'");
    expect_refused(place, "wombat", "Its commands are make, check");
    expect_refused(place, "make --overwrit", "thalweg make has no option '--overwrit'");
    expect_refused(place, "make --theads=3", "Did you mean '--threads'? See thalweg make --help.");
    expect_refused(place, "make -seed 3", "thalweg make has no option '-seed'");
    expect_refused(place, "make -Q", "Did you mean '-q'?");
    expect_refused(place, "--seed 3 make", "Options follow the command.");
    expect_refused(place, "--sed 3 make", "thalweg has no option '--sed'.");
    expect_refused(place, "make -o make --overwrit", "'--overwrit'");
    expect_refused(place, "make --seed", "thalweg make --seed is missing its N");
    expect_refused(place, "completion bsh", "not 'bsh'. Did you mean 'bash'?");
    expect_refused(place, "help maek", "Did you mean 'make'?");
    expect_refused(place, "recipe all", "unknown key 'all'.");
    expect_refused(place, "recipe grid network", "'network' is one word too many for thalweg recipe");
    expect_refused(place, "make --threads -1", "--threads");
    expect_refused(place, "make --device nonsense", "--device is one of cpu, opencl, not 'nonsense'");
    expect_refused(place, "make --device opncl", "Did you mean 'opencl'?");
    expect_refused(place, "make nowhere.toml", "nowhere.toml");
    expect_refused(place, "make .", "");
    expect_refused(place, "check nowhere.gpkg", "nowhere.gpkg");
    expect_refused(place, "stats nowhere.tif", "nowhere.tif");
    expect_refused(place, "replay nowhere", "nowhere");
    expect_refused(place, "make --set nothing", "section.key=value");
}

TEST(BadInput, OpenClDevices) {
    Workplace const place;
    setenv("THALWEG_OPENCL_DEVICE", "9:9", 1);
    expect_refused(place, small + "--device opencl", "THALWEG_OPENCL_DEVICE='9:9' names no device");
    unsetenv("THALWEG_OPENCL_DEVICE");
    setenv("OCL_ICD_VENDORS", "/nonexistent", 1); // where the loader looks for platforms
    expect_refused(place, small + "--device opencl", "no OpenCL platform with a device was found");
    EXPECT_EQ(thalweg_run(small + "-q --device cpu", place.path()).code, 0) << "the processor needs no platform";
    unsetenv("OCL_ICD_VENDORS");
}

TEST(BadInput, RecipeKeys) {
    Workplace const place;
    expect_refused(place, small + "--set network.prun=3", "Did you mean 'network.prune'?");
    expect_refused(place, small + "--set surface.increment=rise_fal", "Did you mean 'rise_fall'?");
    expect_refused(place, small + "--set network.dla.sticking=0", "network.dla.sticking");
    expect_refused(place, small + "--set network.dla.sticking=1.5", "network.dla.sticking");
    expect_refused(place, small + "--set network.dla.visits=0", "network.dla.visits");
    expect_refused(place, small + "--set network.dla.particles=0", "network.dla.particles");
    expect_refused(place, small + "--set network.dla.particles=many", "an integer is required");
    expect_refused(place, small + "--set grid.width=0", "grid.width");
    expect_refused(place, small + "--set grid.cell=0", "grid.cell");
    expect_refused(place, small + "--set grid.cell=-3", "grid.cell");
    expect_refused(place, small + "--set grid.crs=EPSG:4326", "EPSG:4326");
    expect_refused(place, small + "--set grid.crs=nonsense", "nonsense");
    expect_refused(place, "make --set grid.width=900000 --set grid.height=900000", "GB are free");
    place.write("bad.toml", "[grid]\ncell = \"wide\"\n[network]\nprun = 3\n");
    expect_refused(place, "make bad.toml", "line 2: grid.cell: a number is required");
    expect_refused(place, "make bad.toml", "line 4: unknown key 'network.prun'");
}

TEST(BadInput, PruningBeyondEveryPathNamesTheLongest) {
    Workplace const place;
    expect_refused(place, small + "--set network.prune=5000", "the longest is");
}

TEST(BadInput, FolderThatIsTaken) {
    Workplace const place;
    fs::create_directory(place / "out");
    place.write("out/precious.txt", "mine");
    expect_refused(place, small, "--overwrite");
    EXPECT_EQ(file_bytes(place / "out/precious.txt"), "mine");
    place.write("file", "mine");
    expect_refused(place, "make -o file", "file");
    EXPECT_EQ(file_bytes(place / "file"), "mine");
}

TEST(BadInput, LineFiles) {
    Workplace const place;
    auto const with = [&](std::string const& json, std::string const& more = "") {
        place.write("rivers.geojson", json);
        place.write("r.toml", lines_recipe("rivers.geojson", more));
    };
    place.write("r.toml", lines_recipe("missing.gpkg"));
    expect_refused(place, "make r.toml -o out", "missing.gpkg");
    with(geojson(""));
    expect_refused(place, "make r.toml -o out", "rivers.geojson");
    with("{not json");
    expect_refused(place, "make r.toml -o out", "rivers.geojson");
    with(geojson(R"({"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[500000,5000000]}})"));
    expect_refused(place, "make r.toml -o out", "line");
    with(geojson(river(1, "[500000,5000000],[500100,5000100]")), "layer = \"streams\"\n");
    expect_refused(place, "make r.toml -o out", "streams");
    with(geojson(river(3, "[500000,5000000,9],[500050,5000000,12.1],[500100,5000000,12.9],[500200,5000000,1]")),
         "orientation = \"as_drawn\"\n");
    expect_refused(place, "make r.toml -o out", "runs uphill");
    with(geojson(river(1, "[500000,5000000],[500100,5000000]") + "," + river(2, "[500100,5000000],[500100,5000100]") +
                 "," + river(3, "[500100,5000100],[500000,5000000]")));
    expect_refused(place, "make r.toml -o out", "closed rings");
    with(geojson(river(1, "[500000,5000000],[500300,5000000]")));
    expect_refused(place, "make r.toml -o out --set grid.width=10 --set grid.height=10", "outside the grid");
    expect_refused(place, "make r.toml -o out --set network.heights=file", "Z");
    expect_refused(place, "make r.toml -o out --set grid.crs=EPSG:4258", "EPSG:4258");
}

TEST(BadInput, NotANumberInAShapefile) {
    Workplace const place;
    fs::create_directory(place / "in");
    std::string const script = R"(
from osgeo import ogr, osr
s = osr.SpatialReference(); s.ImportFromEPSG(32631)
d = ogr.GetDriverByName('ESRI Shapefile').CreateDataSource('in/r.shp')
l = d.CreateLayer('r', s, ogr.wkbLineString)
g = ogr.Geometry(ogr.wkbLineString)
for p in ((500000, 5000000), (500010.25, 5000010), (500020, 5000020)): g.AddPoint_2D(*p)
f = ogr.Feature(l.GetLayerDefn()); f.SetGeometry(g); l.CreateFeature(f)
d = None
import struct
shape = open('in/r.shp', 'rb').read()
assert shape.count(struct.pack('<d', 500010.25)) == 1
open('in/r.shp', 'wb').write(shape.replace(struct.pack('<d', 500010.25), struct.pack('<d', float('nan'))))
)";
    place.write("in/make.py", script);
    ASSERT_EQ(std::system(("cd '" + place.path().string() + "' && /usr/bin/python3 in/make.py").c_str()), 0);
    place.write("r.toml", lines_recipe("in/r.shp"));
    expect_refused(place, "make r.toml -o out", "vertex");
}

} // namespace bad_input_test
