// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// `thalweg make RIVERS`: terrain around a file of lines, without a recipe.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <ogrsf_frmts.h>
#include <support.hpp>

#include <thalweg/core/vec.hpp>

#include "command.hpp"
#include "refused.hpp"
#include "report.hpp"

namespace given_rivers_test {

using thalweg::cross;
using thalweg::Vec2;

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

std::string const walker = THALWEG_SOURCE_DIR "/samples/walker_nhdplus.gpkg";
std::string const coarse = " --set grid.cell=90"; // quick; what the data choose is another test's

/// Runs one of GDAL's programs; messages of its own are not ours.
void run_gdal(std::string const& command, Workplace const& place) {
    std::string const line = "cd '" + place.path().string() + "' && " + command + " >/dev/null 2>&1";
    ASSERT_EQ(std::system(line.c_str()), 0) << command;
}

struct Box {
    double west, south, east, north;
    bool holds(Box const& b) const { return west <= b.west && south <= b.south && east >= b.east && north >= b.north; }
};

Box box_of_dem(fs::path const& file) {
    GDALAllRegister();
    GDALDatasetUniquePtr const data(GDALDataset::Open(file.string().c_str()));
    if (!data) {
        return {0, 0, 0, 0};
    }
    double frame[6];
    data->GetGeoTransform(frame);
    return {frame[0], frame[3] + frame[5] * data->GetRasterYSize(), frame[0] + frame[1] * data->GetRasterXSize(),
            frame[3]};
}

/// The extent of a file's lines in the CRS of a DEM.
Box box_of_lines(fs::path const& file, fs::path const& dem) {
    GDALDatasetUniquePtr const data(GDALDataset::Open(file.string().c_str(), GDAL_OF_VECTOR));
    GDALDatasetUniquePtr const raster(GDALDataset::Open(dem.string().c_str()));
    Box box{1e300, 1e300, -1e300, -1e300};
    for (auto const& feature : *data->GetLayer(0)) {
        OGRGeometry* const line = feature->GetGeometryRef();
        OGRSpatialReference target = *raster->GetSpatialRef();
        target.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        line->transformTo(&target);
        OGREnvelope e;
        line->getEnvelope(&e);
        box = {std::min(box.west, e.MinX), std::min(box.south, e.MinY), std::max(box.east, e.MaxX),
               std::max(box.north, e.MaxY)};
    }
    return box;
}

/// Exit 0, every check holds, the DEM lies over the rivers. Gives the report.
json made(Workplace const& place, std::string const& input, std::string const& options, std::string const& folder) {
    Outcome const o = expect_run(place, "make '" + input + "'" + options + " -o " + folder, 0, "\ngrid ");
    if (o.code != 0) {
        return {};
    }
    json const report = report_of(place / folder);
    expect_checks_hold(report, input);
    return report;
}

void refused(Workplace const& place, std::string const& arguments, std::string const& words) {
    expect_refused(place, "make " + arguments + " -o out", words);
}

std::string const utm = R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":)"
                        R"("urn:ogc:def:crs:EPSG::32631"}},"features":[)";

std::string line(std::string const& coordinates) {
    return R"({"type":"Feature","properties":{},"geometry":{"type":"LineString","coordinates":[)" + coordinates + "]}}";
}

} // namespace

TEST(GivenRivers, TheDataChooseTheGrid) {
    Workplace const place;
    json const report = made(place, walker, "", "out");
    ASSERT_TRUE(report.contains("recipe"));
    EXPECT_EQ(report["recipe"]["grid"]["cell"], 25.0);
    EXPECT_EQ(report["recipe"]["grid"]["crs"], "EPSG:32610");
    EXPECT_EQ(report["recipe"]["surface"]["method"], "equilibrium");
    double const cells = report["dem"]["cells"];
    EXPECT_GT(cells, 5e5);
    EXPECT_LE(cells, 2e6);
    EXPECT_TRUE(box_of_dem(place / "out/dem.tif").holds(box_of_lines(walker, place / "out/dem.tif")));
    EXPECT_EQ(thalweg_run("check out --dem out/dem.tif", place.path()).code, 0);
    EXPECT_EQ(thalweg_run("replay out --verify", place.path()).code, 0);

    // The recipe it would use makes the same land, from any folder.
    Outcome const recipe = expect_run(place, "recipe --for '" + walker + "'", 0);
    fs::create_directories(place / "elsewhere");
    place.write("elsewhere/r.toml", recipe.out);
    made(place, "elsewhere/r.toml", "", "again");
    for (char const* file : {"dem.tif", "network.gpkg"}) {
        EXPECT_TRUE(file_bytes(place / "out" / file) == file_bytes(place / "again" / file)) << file;
    }
}

TEST(GivenRivers, AnyFormatGivesTheSameLand) {
    Workplace const place;
    made(place, walker, coarse, "gpkg");
    run_gdal("ogr2ogr -f FlatGeobuf -lco SPATIAL_INDEX=NO rivers.fgb '" + walker + "'", place);
    run_gdal("ogr2ogr rivers.shp '" + walker + "'", place);
    run_gdal("ogr2ogr -lco COORDINATE_PRECISION=15 rivers.geojson '" + walker + "'", place);
    run_gdal("ogr2ogr -f KML rivers.kml '" + walker + "'", place);
    run_gdal("mkdir shapes && cp rivers.shp rivers.shx rivers.dbf rivers.prj shapes", place);
    run_gdal("/usr/bin/python3 -c \"import shutil; shutil.make_archive('packed', 'zip', '.', 'shapes')\"", place);
    for (std::string const file :
         {"rivers.fgb", "rivers.shp", "rivers.geojson", "rivers.kml", "shapes/", "packed.zip"}) {
        std::string const folder = "of_" + std::to_string(file.size()) + file.substr(file.size() - 3, 2);
        json const report = made(place, file, coarse, folder);
        EXPECT_EQ(report["network"]["outlets"], 1) << file;
        EXPECT_TRUE(box_of_dem(place / folder / "dem.tif").holds(box_of_lines(walker, place / folder / "dem.tif")));
        EXPECT_EQ(thalweg_run("replay " + folder + " --verify", place.path()).code, 0) << file;
    }
    for (std::string const same : {"of_10sh", "of_10fg", "of_10zi"}) {
        if (fs::exists(place / same)) {
            EXPECT_TRUE(file_bytes(place / same / "dem.tif") == file_bytes(place / "gpkg/dem.tif")) << same;
        }
    }
}

TEST(GivenRivers, FoldersThatThalwegWrote) {
    Workplace const place;
    made(place, walker, coarse, "first");
    json const again = made(place, "first/", coarse + " --seed 8", "second");
    EXPECT_TRUE(test::has(file_bytes(place / "second/recipe.toml"), "path = 'inputs/network.gpkg'"));
    EXPECT_EQ(again["recipe"]["network"]["lines"]["layer"], "arcs");
    EXPECT_EQ(again["network"]["arcs"], report_of(place / "first")["network"]["arcs"]);
    fs::create_directories(place / "converted");
    ASSERT_EQ(thalweg_run("convert first -o converted/net.shp", place.path()).code, 0);
    made(place, "converted", coarse, "third");
    EXPECT_EQ(thalweg_run("replay third --verify", place.path()).code, 0);
    for (std::string const name : {"net.gpkg", "net.fgb", "net.geojson"}) {
        std::string const folder = "of_" + name;
        fs::create_directories(place / folder);
        ASSERT_EQ(thalweg_run("convert first -o " + folder + "/" + name, place.path()).code, 0) << name;
        Outcome const o = expect_run(place, "recipe --for " + folder, 0);
        EXPECT_TRUE(test::has(o.out, name == "net.gpkg" ? "/net.gpkg'" : "/net_arcs."));
    }
}

TEST(GivenRivers, ALayerIsChosenByItsName) {
    Workplace const place;
    run_gdal("ogr2ogr -nln NHDFlowline nhd.gpkg '" + walker + "'", place);
    run_gdal("ogr2ogr -update -nln NHDLine nhd.gpkg '" + walker + "' -where 'COMID < 0'", place); // empty
    run_gdal("ogr2ogr -update -nln roads nhd.gpkg '" + walker + "'", place);
    made(place, "nhd.gpkg", coarse, "out");
    fs::remove_all(place / "out");
    run_gdal("ogr2ogr -nln one two.gpkg '" + walker + "'", place);
    run_gdal("ogr2ogr -update -nln other two.gpkg '" + walker + "'", place);
    refused(place, "two.gpkg", "two.gpkg has 2 layers with lines (one, other)");
    made(place, "two.gpkg", coarse + " --set network.lines.layer=other", "out");
}

TEST(GivenRivers, OneShortLine) {
    Workplace const place;
    place.write("line.geojson", utm + line("[500000,4000000],[501000,4000300]") + "]}");
    json const report = made(place, "line.geojson", "", "out");
    EXPECT_EQ(report["recipe"]["grid"]["cell"], 1.25);
    json const small = made(place, "line.geojson", " --set grid.width=200 --set grid.height=200", "small");
    EXPECT_EQ(small["recipe"]["grid"]["cell"], 6.0);
}

TEST(GivenRivers, WhatIsNeitherIsRefusedInWords) {
    Workplace const place;
    refused(place, "nothing.gpkg", "nothing.gpkg does not exist");
    place.write("empty.gpkg", "");
    refused(place, "empty.gpkg", "empty.gpkg is empty");
    place.write("words.txt", "The quick brown fox\n");
    refused(place, "words.txt", "words.txt is not a file with lines that GDAL can read");
    fs::create_directories(place / "folder");
    refused(place, "folder", "folder holds no rivers: the folder is empty");
    place.write("folder/readme", "hello");
    refused(place, "folder", "holds neither network.gpkg");
    refused(place, "'" THALWEG_SOURCE_DIR "/samples/bigtujunga_srtm1.tif'", "is a raster, not river lines");
    place.write("points.geojson", R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},)"
                                  R"("geometry":{"type":"Point","coordinates":[1,2]}}]})");
    refused(place, "points.geojson", "points.geojson has no layer with lines (points)");
    place.write("point.geojson", utm + line("[500000,4000000],[500000,4000000]") + "]}");
    refused(place, "point.geojson", "holds no line: feature 1 has no line of any length");
    expect_run(place, "make '" THALWEG_SOURCE_DIR "/samples/points.toml' -q -o dots", 0);
    refused(place, "dots", "its terrain has no rivers");
}

TEST(GivenRivers, ARecipeOfAnyNameIsARecipe) {
    Workplace const place;
    place.write("recipe", "# mine\n\n[grid]\nwidth = 64\nheight = 64\n[network]\n[network.dla]\nparticles = 500\n"
                          "[surface]\n");
    EXPECT_EQ(thalweg_run("make recipe -q -o out", place.path()).code, 0);
    fs::remove_all(place / "out");
    place.write("faulty.txt", "sed = 7\n");
    refused(place, "faulty.txt", "Did you mean 'seed'?");
    place.write("broken.toml", "\x01\x02");
    refused(place, "broken.toml", "broken.toml: line 1");
}

TEST(GivenRivers, FilesInSetAreFoundFromTheCurrentFolder) {
    Workplace const place;
    fs::create_directories(place / "recipes/deep");
    fs::create_directories(place / "data");
    fs::copy_file(walker, place / "data/w.gpkg");
    fs::copy_file(walker, place / "recipes/deep/own.gpkg");
    place.write("recipes/deep/r.toml", "[grid]\ncell = 90\n[network]\nsource = \"lines\"\n[network.lines]\npath = "
                                       "\"own.gpkg\"\n[surface]\n");
    made(place, "recipes/deep/r.toml", "", "own");
    json const set = made(place, "recipes/deep/r.toml", " --set network.lines.path=data/w.gpkg", "set");
    EXPECT_FALSE(test::has(set["recipe"]["network"]["lines"]["path"].get<std::string>(), "own"));
    EXPECT_TRUE(fs::exists(place / "set/inputs/w.gpkg"));
    EXPECT_FALSE(test::has(file_bytes(place / "set/recipe.toml"), place.path().string()));
    EXPECT_EQ(thalweg_run("replay set --verify", place.path()).code, 0);
    refused(place, "recipes/deep/r.toml --set network.lines.path=own.gpkg", "own.gpkg");
}

TEST(GivenRivers, TheCrsIsAsked) {
    Workplace const place;
    json const report = made(place, walker, coarse + " --crs EPSG:3310", "out");
    EXPECT_EQ(report["recipe"]["grid"]["crs"], "EPSG:3310");
    EXPECT_TRUE(box_of_dem(place / "out/dem.tif").holds(box_of_lines(walker, place / "out/dem.tif")));
    fs::remove_all(place / "out");
    refused(place, "'" + walker + "' --crs EPSG:4326", "geographic");
    refused(place, "'" + walker + "' --crs EPSG:2227", "US survey foot");
    refused(place, "'" + walker + "' --crs nonsense", "is not a coordinate system");
}

TEST(GivenRivers, CoarserCellsHaveGentlerSlopes) {
    Workplace const place;
    auto const slope_at = [&](std::string const& cell) {
        expect_run(place, "make '" + walker + "' -o out" + cell + " --set grid.cell=" + cell, 0);
        json const report = report_of(place / ("out" + cell));
        return report["recipe"]["surface"]["mean_slope"].get<double>();
    };
    EXPECT_EQ(slope_at("30"), 25.0);
    EXPECT_EQ(slope_at("75"), 22.5);
    EXPECT_EQ(slope_at("300"), 16.0);
    expect_run(place, "make '" + walker + "' --set surface.relief=12000 -o high", 0,
               "warning: the terrain is 12000 m high");
}

TEST(GivenRivers, ATributaryThatDoesNotQuiteMeetItsRiverIsSaid) {
    Workplace const place;
    auto const line = [](std::string const& vertices) {
        return R"({"type":"Feature","properties":{},"geometry":{"type":"LineString","coordinates":[)" + vertices +
               "]}}";
    };
    place.write(
        "gap.geojson",
        R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32631"}},)"
        R"("features":[)" +
            line("[500000,5005000],[505000,5004000],[510000,5005000]") + "," +
            line("[505000,5009000],[505000,5004070]") + "]}");
    Outcome const o = thalweg_run("make gap.geojson --set grid.cell=50 -o out", place.path());
    EXPECT_TRUE(test::has(o.err, "warning: 1 river ends within 2 cells", "--set network.lines.snap=150"));
    Outcome const joined =
        thalweg_run("make gap.geojson --set grid.cell=50 --set network.lines.snap=100 -o joined", place.path());
    EXPECT_EQ(joined.code, 0) << joined.err;
    EXPECT_FALSE(test::has(joined.err, "within 2 cells"));
    EXPECT_EQ(report_of(place / "joined")["network"]["outlets"], 1);
}

struct Stroke {
    Vec2 a, b;
};

/// Strokes at random over 12 km, none of which crosses another.
std::string scattered_strokes(int count, std::uint64_t seed) {
    std::mt19937_64 random_word(seed);
    auto const within = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(random_word() >> 11U) / 9007199254740992.0;
    };
    std::vector<Stroke> strokes;
    while (strokes.size() < static_cast<std::size_t>(count)) {
        Vec2 const from{within(600.0, 11400.0), within(600.0, 11400.0)};
        double const length = within(300.0, 1200.0);
        double const along = within(-1.0, 1.0);
        double const side = random_word() % 2 == 0 ? 1.0 : -1.0;
        Vec2 const to{from.x + length * along, from.y + side * length * std::sqrt(1.0 - along * along)};
        bool const free = std::none_of(strokes.begin(), strokes.end(), [&](Stroke const& s) {
            return cross(from, to, s.a) * cross(from, to, s.b) <= 0.0 &&
                   cross(s.a, s.b, from) * cross(s.a, s.b, to) <= 0.0;
        });
        if (free && std::min({to.x, to.y}) > 400.0 && std::max({to.x, to.y}) < 11600.0) {
            strokes.push_back({from, to});
        }
    }
    std::string features;
    for (Stroke const& s : strokes) {
        features += fmt::format(R"({}{{"type":"Feature","properties":{{}},"geometry":{{"type":"LineString",)"
                                R"("coordinates":[[{},{}],[{},{}]]}}}})",
                                features.empty() ? "" : ",", 500000.0 + s.a.x, 4988000.0 + s.a.y, 500000.0 + s.b.x,
                                4988000.0 + s.b.y);
    }
    return R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32631"}},)"
           R"("features":[)" +
           features + "]}";
}

TEST(GivenRivers, StrokesThatNearlyTouchPassAllChecksOnceTheAdviceIsTaken) {
    Workplace const place;
    place.write("strokes.geojson", scattered_strokes(200, 1));
    for (std::string const method : {"equilibrium", "dilate"}) {
        std::string const words = "make strokes.geojson --set grid.cell=30 --set grid.width=400 --set grid.height=400 "
                                  "--set 'grid.origin=[500000,5000000]' --set surface.method=" +
                                  method + " --overwrite -o out";
        Outcome const raw = thalweg_run(words, place.path());
        EXPECT_TRUE(test::has(raw.err, "network.lines.snap=90"));
        Outcome const o = expect_run(place, words + " --set network.lines.snap=90", 0);
        EXPECT_FALSE(test::has(o.err, "network.lines.snap")) << "it is taken\n";
    }
}

TEST(GivenRivers, FieldsOfLinksCanBeNamed) {
    Workplace const place;
    auto const river = [](std::string const& ids, std::string const& vertices) {
        return R"({"type":"Feature","properties":{)" + ids + R"(},"geometry":{"type":"LineString","coordinates":[)" +
               vertices + "]}}";
    };
    // Drawn from the mouth upward.
    place.write(
        "up.geojson",
        R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32632"}},"features":[)" +
            river(R"("own":1,"next":0)", "[500000,5000000],[500200,5002500],[500000,5005000]") + "," +
            river(R"("own":2,"next":1)", "[500000,5005000],[500300,5007500],[499000,5010000]") + "," +
            river(R"("own":3,"next":1)", "[500000,5005000],[502000,5007000],[504000,5009500]") + "]}");
    json const report = made(place, "up.geojson", coarse + " --field arc_id=own --field ds_arc=next", "out");
    EXPECT_EQ(report["recipe"]["network"]["lines"]["down_field"], "next");
    EXPECT_NEAR(report["given"]["turned_m"].get<double>(), report["given"]["kept_m"].get<double>(), 1.0);
    expect_refused(place, "make up.geojson -o a --field ds_arc=next",
                   "the field 'next' is named without its other half");
    expect_refused(place, "make up.geojson -o a --field arc_id=own --field ds_arc=nxt", "Did you mean 'next'?");
    expect_refused(place, "make up.geojson -o a --field strahler=own", "make reads arc_id, ds_arc, key");
    expect_refused(place, "make up.geojson -o a --field next", "write QUANTITY=NAME");
}

TEST(GivenRivers, ALayerOfMixedShapesWithoutCrs) {
    Workplace const place;
    place.write("mixed.csv", "WKT,waterway\n"
                             "POINT (500500 5004000),spring\n"
                             "\"POLYGON ((0 0,1 0,1 1,0 0))\",\n"
                             "\"LINESTRING (500000 5005000,500200 5002500,500000 5000000)\",river\n"
                             "\"GEOMETRYCOLLECTION (POINT (1 1),LINESTRING (499000 5010000,500000 5005000))\",stream\n"
                             "\"LINESTRING (504000 5009500,500000 5005000)\",stream\n");
    run_gdal("ogr2ogr mixed.gpkg mixed.csv -nlt GEOMETRY -nln rivers -a_srs NONE", place);
    expect_refused(place, "make mixed.gpkg -o a", "layer rivers of mixed.gpkg has no CRS");
    Outcome const o = expect_run(place, "make mixed.gpkg --source-crs EPSG:32632 -o out" + coarse, 0,
                                 "2 shapes of type Point are not lines and are skipped",
                                 "1 shape of type Polygon is not a line and is skipped");
    json const report = json::parse(file_bytes(place / "out/report.json"));
    EXPECT_EQ(report["recipe"]["grid"]["crs"], "EPSG:32632");
    EXPECT_EQ(thalweg_run("recipe --for mixed.gpkg", place.path()).code, 2);
    Outcome const recipe = expect_run(place, "recipe --for mixed.gpkg --source-crs EPSG:32632", 0);
    EXPECT_TRUE(test::has(recipe.out, "source_crs = 'EPSG:32632'"));
    // The recipe of the folder makes the same again.
    Outcome const again = expect_run(place, "make out/recipe.toml -o again", 0);
    EXPECT_EQ(file_bytes(place / "out/dem.tif"), file_bytes(place / "again/dem.tif"));
}

} // namespace given_rivers_test
