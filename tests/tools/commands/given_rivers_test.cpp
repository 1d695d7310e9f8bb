// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// `thalweg make RIVERS`: terrain around a file of lines, without a recipe.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <io/vector_files.hpp>
#include <support.hpp>

#include <thalweg/core/vec.hpp>

#include "command.hpp"

namespace given_rivers_test {

using thalweg::cross;
using thalweg::Vec2;

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

std::string const walker = samples + "walker_nhdplus.gpkg";
std::string const coarse = " --set grid.cell=90"; // quick; what the data choose is another test's

struct Box {
    double west, south, east, north;
    bool holds(Box const& b) const { return west <= b.west && south <= b.south && east >= b.east && north >= b.north; }
};

Box box_of_dem(fs::path const& file) {
    auto const data = opened(file);
    double frame[6];
    data->GetGeoTransform(frame);
    return {frame[0], frame[3] + frame[5] * data->GetRasterYSize(), frame[0] + frame[1] * data->GetRasterXSize(),
            frame[3]};
}

/// The extent of a file's lines in the CRS of a DEM.
Box box_of_lines(fs::path const& file, fs::path const& dem) {
    auto const data = opened(file);
    auto const raster = opened(dem);
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
    expect_run(place, "make '" + input + "'" + options + " -q -o " + folder, 0);
    json const report = report_of(place / folder);
    expect_checks_hold(report, input);
    return report;
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
    expect_run(place, "check out --dem out/dem.tif", 0);
    expect_run(place, "replay out --verify", 0);

    // The recipe it would use makes the same land, from any folder.
    Outcome const recipe = expect_run(place, "recipe --for '" + walker + "'", 0);
    fs::create_directories(place / "elsewhere");
    place.write("elsewhere/r.toml", recipe.out);
    made(place, "elsewhere/r.toml", "", "again");
    for (char const* file : {"dem.tif", "network.gpkg"}) {
        EXPECT_TRUE(file_bytes(place / "out" / file) == file_bytes(place / "again" / file)) << file;
    }
}

TEST(GivenRivers, RiversMayEndOnTheGridsEdge) {
    Workplace const place;
    int number = 0;
    for (char const* const end : {"[501500,4997600]", "[503000,4998800]", "[503000,4997600]", "[500000,4998800]",
                                  "[501500,5000000]", "[500000,5000000]"}) {
        std::string const name = fmt::format("edge{}", number++);
        test::write(place / (name + ".geojson"), test::geojson(test::line(std::string("[501500,4998700],") + end)));
        expect_run(place,
                   "make " + name + ".geojson --set grid.width=100 --set grid.height=80 --set grid.cell=30 " +
                       "--set grid.origin=[500000,5000000] --only dem,network -q -o " + name,
                   0);
        expect_checks_hold(report_of(place / name));
    }
}

// Rivers run along the edge of such windows, meet there, leave and come back.
TEST(GivenRivers, APartOfACoastPassesItsChecks) {
    Workplace const place;
    for (std::string const window : {"width=309 --set grid.height=213 --set grid.origin=[386130,4460910]",
                                     "width=160 --set grid.height=200 --set grid.origin=[400350,4452375]",
                                     "width=348 --set grid.height=132 --set grid.origin=[389850,4461000]",
                                     "width=133 --set grid.height=133 --set grid.origin=[390000,4460025]"}) {
        expect_run(
            place,
            "make " + samples +
                "coastal_nhdplus.gpkg -o part --overwrite -q --set grid.cell=60 --set grid.clip=true --set grid." +
                window,
            0);
        json const given = report_of(place / "part")["given"];
        EXPECT_GT(given["kept_m"], 20000.0);
        EXPECT_GT(given["left_out_m"]["grid"], 100000.0);
    }
}

TEST(GivenRivers, AnyFormatGivesTheSameLand) {
    Workplace const place;
    made(place, walker, coarse, "gpkg");
    place.shell("ogr2ogr -f FlatGeobuf -lco SPATIAL_INDEX=NO rivers.fgb " + walker + " && ogr2ogr rivers.shp " +
                walker + " && ogr2ogr -lco COORDINATE_PRECISION=15 rivers.geojson " + walker +
                " && ogr2ogr -f KML rivers.kml " + walker +
                " && mkdir shapes && cp rivers.shp rivers.shx rivers.dbf rivers.prj shapes && " +
                R"~(/usr/bin/python3 -c "import shutil; shutil.make_archive('packed', 'zip', '.', 'shapes')")~");
    for (std::string const file :
         {"rivers.fgb", "rivers.shp", "rivers.geojson", "rivers.kml", "shapes/", "packed.zip"}) {
        std::string const folder = "of_" + file.substr(file.find('.') + 1, 3); // of_sha for shapes/
        json const report = made(place, file, coarse, folder);
        EXPECT_EQ(report["network"]["outlets"], 1) << file;
        EXPECT_TRUE(box_of_dem(place / folder / "dem.tif").holds(box_of_lines(walker, place / folder / "dem.tif")));
        expect_run(place, "replay " + folder + " --verify", 0);
    }
    for (std::string const same : {"of_shp", "of_fgb", "of_zip"}) {
        EXPECT_TRUE(file_bytes(place / same / "dem.tif") == file_bytes(place / "gpkg/dem.tif")) << same;
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
    expect_run(place, "convert first -o converted/net.shp", 0);
    made(place, "converted", coarse, "third");
    expect_run(place, "replay third --verify", 0);
    for (std::string const name : {"net.gpkg", "net.fgb", "net.geojson"}) {
        std::string const folder = "of_" + name;
        fs::create_directories(place / folder);
        expect_run(place, "convert first -o " + folder + "/" + name, 0);
        Outcome const o = expect_run(place, "recipe --for " + folder, 0);
        EXPECT_TRUE(test::has(o.out, name == "net.gpkg" ? "/net.gpkg'" : "/net_arcs."));
    }
}

TEST(GivenRivers, WhatHoldsNoRiversIsRefused) {
    Workplace const place;
    place.write("empty.gpkg", "");
    place.write("words.txt", "The quick brown fox\n");
    fs::create_directories(place / "folder");
    place.write("point.geojson", test::geojson(test::line("[500000,4000000],[500000,4000000]")));
    expect_run(place, "make " + samples + "points.toml -q -o dots", 0); // a terrain without rivers
    expect_refused(place, "make -o out",
                   {"nothing.gpkg", "empty.gpkg", "words.txt", "folder", "point.geojson", "dots"});
}

TEST(GivenRivers, ARecipeOfAnyNameIsARecipe) {
    Workplace const place;
    place.write("recipe", "# mine\n\n[grid]\nwidth = 64\nheight = 64\n[network]\n[network.dla]\nparticles = 500\n"
                          "[surface]\n");
    expect_run(place, "make recipe -q -o out", 0);
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
    expect_run(place, "replay set --verify", 0);
    expect_refused(place, "make recipes/deep/r.toml -o no", {"--set network.lines.path=own.gpkg"});
}

TEST(GivenRivers, TheCrsIsAsked) {
    Workplace const place;
    json const report = made(place, walker, coarse + " --crs EPSG:3310", "out");
    EXPECT_EQ(report["recipe"]["grid"]["crs"], "EPSG:3310");
    EXPECT_TRUE(box_of_dem(place / "out/dem.tif").holds(box_of_lines(walker, place / "out/dem.tif")));
    expect_refused(place, "make " + walker + " -o no --crs", {"EPSG:4326", "EPSG:2227", "nonsense"});
}

TEST(GivenRivers, CoarserCellsHaveGentlerSlopes) {
    Workplace const place;
    for (auto const& [cell, slope] : {std::pair("30", 25.0), std::pair("75", 22.5), std::pair("300", 16.0)}) {
        json const report = made(place, walker, std::string(" --set grid.cell=") + cell, std::string("out") + cell);
        EXPECT_EQ(report["recipe"]["surface"]["mean_slope"], slope);
    }
    expect_run(place, "make " + walker + " --set surface.relief=12000 -o high", 0, "warning: ", "12000");
}

TEST(GivenRivers, ATributaryThatDoesNotQuiteMeetItsRiverIsReported) {
    Workplace const place;
    place.write("gap.geojson", test::geojson(test::line("[500000,5005000],[505000,5004000],[510000,5005000]") + "," +
                                             test::line("[505000,5009000],[505000,5004070]")));
    std::string const make = "make gap.geojson --set grid.cell=50 ";
    Outcome const o = thalweg_run(make + "--set network.lines.snap=1 -o apart", place.path());
    EXPECT_TRUE(test::has(o.err, "1 river ends 68.6 m from another river", "network.lines.snap=69"));
    for (std::string const words : {"-o clear", "--set network.lines.snap=69 -o joined"}) { // nothing else is near
        EXPECT_FALSE(test::has(expect_run(place, make + words, 0).err, "[unjoined_ends]"));
        EXPECT_EQ(report_of(place / words.substr(words.rfind(' ') + 1))["network"]["outlets"], 1);
    }
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
        features += (features.empty() ? "" : ",") +
                    test::line(fmt::format("[{},{}],[{},{}]", 500000.0 + s.a.x, 4988000.0 + s.a.y, 500000.0 + s.b.x,
                                           4988000.0 + s.b.y));
    }
    return test::geojson(features);
}

TEST(GivenRivers, StrokesThatNearlyTouchPassAllChecksOnceTheAdviceIsTaken) {
    Workplace const place;
    place.write("strokes.geojson", scattered_strokes(200, 1));
    for (std::string const method : {"equilibrium", "dilate"}) {
        std::string const words = "make strokes.geojson --set grid.cell=30 --set grid.width=400 --set grid.height=400 "
                                  "--set 'grid.origin=[500000,5000000]' --set surface.method=" +
                                  method + " --overwrite -o out";
        Outcome const raw = thalweg_run(words, place.path());
        EXPECT_TRUE(test::has(raw.err, "network.lines.snap="));
        Outcome const o = expect_run(place, words + " --set network.lines.snap=90", 0);
        EXPECT_FALSE(test::has(o.err, "network.lines.snap")) << "it is taken\n";
    }
}

TEST(GivenRivers, FieldsOfLinksCanBeNamed) {
    Workplace const place;
    // Drawn from the mouth upward.
    place.write(
        "up.geojson",
        test::geojson(test::line("[500000,5000000],[500200,5002500],[500000,5005000]", R"("own":1,"next":0)") + "," +
                      test::line("[500000,5005000],[500300,5007500],[499000,5010000]", R"("own":2,"next":1)") + "," +
                      test::line("[500000,5005000],[502000,5007000],[504000,5009500]", R"("own":3,"next":1)")));
    json const report = made(place, "up.geojson", coarse + " --field arc_id=own --field ds_arc=next", "out");
    EXPECT_EQ(report["recipe"]["network"]["lines"]["down_field"], "next");
    EXPECT_NEAR(report["given"]["turned_m"].get<double>(), report["given"]["kept_m"].get<double>(), 1.0);
    expect_refused(place, "make up.geojson -o a --field",
                   {"ds_arc=next", "arc_id=own --field ds_arc=nxt", "strahler=own", "next"});
}

TEST(GivenRivers, ALayerOfMixedShapesWithoutCrs) {
    Workplace const place;
    place.write("mixed.csv", "WKT,waterway\n"
                             "POINT (500500 5004000),spring\n"
                             "\"POLYGON ((0 0,1 0,1 1,0 0))\",\n"
                             "\"LINESTRING (500000 5005000,500200 5002500,500000 5000000)\",river\n"
                             "\"GEOMETRYCOLLECTION (POINT (1 1),LINESTRING (499000 5010000,500000 5005000))\",stream\n"
                             "\"LINESTRING (504000 5009500,500000 5005000)\",stream\n");
    place.shell("ogr2ogr mixed.gpkg mixed.csv -nlt GEOMETRY -nln rivers -a_srs NONE");
    expect_refused(place, "", {"make mixed.gpkg -o a", "recipe --for mixed.gpkg"});
    expect_run(place, "make mixed.gpkg --source-crs EPSG:32632 -o out" + coarse, 0);
    EXPECT_EQ(report_of(place / "out")["recipe"]["grid"]["crs"], "EPSG:32632");
    Outcome const recipe = expect_run(place, "recipe --for mixed.gpkg --source-crs EPSG:32632", 0);
    EXPECT_TRUE(test::has(recipe.out, "source_crs = 'EPSG:32632'"));
    // The recipe of the folder makes the same again.
    expect_run(place, "make out/recipe.toml -o again", 0);
    EXPECT_EQ(file_bytes(place / "out/dem.tif"), file_bytes(place / "again/dem.tif"));
}

} // namespace given_rivers_test
