// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include <gtest/gtest.h>
#include <io/vector_files.hpp>
#include <support.hpp>

#include <thalweg/io/raster/raster_files.hpp>

#include "command.hpp"

namespace convert_test {

namespace fs = std::filesystem;

namespace {

/// Three rivers that meet, without heights; a fourth joins below. Drawn by hand, in no schema.
std::string const lines = test::geojson(test::line("[400,900],[500,500]", R"("nr":11,"into":14)") + "," +
                                        test::line("[500,900],[500,500]", R"("nr":12,"into":14)") + "," +
                                        test::line("[600,900],[500,500]", R"("nr":13,"into":14)") + "," +
                                        test::line("[500,500],[500,300]", R"("nr":14,"into":16)") + "," +
                                        test::line("[800,500],[500,300]", R"("nr":15,"into":16)") + "," +
                                        test::line("[500,300],[500,100]", R"("nr":16,"into":0)"));

std::string const read_lines = "rivers.geojson --field arc_id=nr --field ds_arc=into ";

/// The arcs of a GeoPackage in thalweg's own columns, but for what tells from which file they came.
std::string network_in(fs::path const& gpkg) {
    auto const data = opened(gpkg);
    OGRLayer* const arcs = data == nullptr ? nullptr : data->GetLayerByName("arcs");
    if (arcs == nullptr) {
        return "no arcs in " + gpkg.string();
    }
    std::string text;
    for (auto const& arc : *arcs) {
        for (char const* const field :
             {"arc_id", "from_node", "to_node", "ds_arc", "n_up", "basin_id", "topo_ord", "strahler", "shreve", "hack",
              "length", "length_3d", "straight", "z_up", "z_down", "dist_out", "slope", "us_area", "ds_area"}) {
            text += std::string(arc->GetFieldAsString(field)) + " ";
        }
        text += arc->GetGeometryRef()->exportToWkt() + "\n";
    }
    return text;
}

} // namespace

TEST(Convert, RefusesWhatCannotBeAndLeavesNothing) {
    Workplace const place;
    place.write("rivers.geojson", lines);
    place.write("taken.gpkg", "mine");
    std::string two_ways = lines;
    two_ways.replace(two_ways.find("[500,300],[500,100]"), 19, "[500,500],[500,100]"); // not a tree
    place.write("two_ways.geojson", two_ways);
    fs::create_directory(place / "folder");
    expect_refused(place, "convert",
                   {"", "rivers.geojson", "nowhere.gpkg -o a.gpkg", "rivers.geojson --field nr -o a.gpkg",
                    "two_ways.geojson --field arc_id=nr --field ds_arc=into -o a.gpkg",
                    "folder/arcs.shp -o folder/nodes.shp --schema grass", "PG:dbname=x -o PG:dbname=x --overwrite"});
    expect_refused(place, "convert " + read_lines + "-o",
                   {"a.kml", "none/a.gpkg", "taken.gpkg", "a.gpkg --schema taudems", "a.gpkg --schema taudem",
                    "a.gpkg --max-upstream 1", "a.tif", "rivers.geojson --schema grass --overwrite",
                    "PG:dbname=x --table 'a; drop table b'"});
}

namespace {

std::vector<double> heights_in(fs::path const& gpkg) {
    std::vector<double> heights;
    auto const data = opened(gpkg);
    for (auto const& arc : *data->GetLayerByName("arcs")) {
        for (OGRPoint const& v : *arc->GetGeometryRef()->toLineString()) {
            heights.push_back(v.getZ());
        }
    }
    return heights;
}

} // namespace

TEST(Convert, ForeignLinesBecomeEverySchemaAndFormat) {
    Workplace const place;
    place.write("rivers.geojson", lines);
    for (std::string const schema : {"native", "taudem", "nhdplus", "hydrorivers", "grass"}) {
        for (std::string const ending : {"gpkg", "shp", "fgb", "geojson", "graphml", "csv", "edges", "tif"}) {
            std::string const name = schema + "." + ending;
            std::string const exact = ending == "geojson" ? " --format geojson2008" : "";
            Outcome const outcome = expect_run(place,
                                               "convert " + read_lines + "-o " + name + " --schema " + schema +
                                                   " --max-upstream 2 --cell 10 -q" + exact,
                                               0);
            EXPECT_EQ(outcome.err, "");
            bool const two_files = schema == "native" && (ending == "shp" || ending == "fgb" || ending == "geojson");
            std::string const first = two_files ? schema + "_arcs." + ending : name;
            EXPECT_TRUE(test::has(outcome.out, first + "\n"));
            if (ending == "graphml" || ending == "csv" || ending == "edges" || ending == "tif") {
                continue;
            }
            // And back: the network is the same.
            auto const json =
                expect_run(place, "convert " + first + " -o back_" + schema + "_" + ending + ".gpkg --json -q", 0)
                    .json();
            EXPECT_EQ(json.at("schema"), schema);
            EXPECT_EQ(json.at("arcs"), 7);
            EXPECT_EQ(json.at("nodes"), 8);
            EXPECT_EQ(json.at("crs"), "EPSG:32631");
        }
    }
    EXPECT_EQ(file_bytes(place / "rivers.geojson"), lines);
    // From whatever schema: the same network.
    expect_run(place, "check back_native_gpkg.gpkg", 0);
    // The columns of each format's file come along as the user's, so files differ in them alone.
    EXPECT_EQ(network_in(place / "back_taudem_gpkg.gpkg"), network_in(place / "back_taudem_fgb.gpkg"));
    EXPECT_EQ(network_in(place / "back_grass_shp.gpkg"), network_in(place / "back_grass_geojson.gpkg"));
}

TEST(Convert, GeoJsonIsInDegreesAndSaysSo) {
    Workplace const place;
    place.write("rivers.geojson", lines);
    Outcome const made = expect_run(
        place, "convert " + read_lines + "-o a.geojson --schema hydrorivers --max-upstream 2", 0,
        "GeoJSON is written in degrees (WGS 84), as RFC 7946 has it, not in EPSG:32631", "geojson2008", "in_degrees ");
    EXPECT_FALSE(test::has(file_bytes(place / "a.geojson"), "\"crs\""));
    auto const back = expect_run(place, "convert a.geojson -o a.gpkg --json -q", 0).json();
    EXPECT_EQ(back.at("arcs"), 7);
    EXPECT_EQ(back.at("nodes"), 8);
    Outcome const old = expect_run(
        place, "convert " + read_lines + "-o b.geojson --format geojson2008 --schema hydrorivers --max-upstream 2", 0);
    EXPECT_FALSE(test::has(old.err, "in_degrees"));
    EXPECT_TRUE(test::has(file_bytes(place / "b.geojson"), "urn:ogc:def:crs:EPSG::32631"));
}

TEST(Convert, LinesOfCsvAreFoundByTheNamesThatProgramsGiveThem) {
    Workplace const place;
    place.write("rivers.geojson",
                test::geojson(test::line("[500000,5002000,90],[500500,5001000,60]", R"("nr":11,"into":14)") + "," +
                              test::line("[502000,5002000,80],[500500,5001000,60]", R"("nr":12,"into":14)") + "," +
                              test::line("[500500,5001000,60],[500400,5000000,20]", R"("nr":14,"into":0)")));
    expect_run(place, "convert " + read_lines + "-o rivers.csv", 0);
    std::string const text = file_bytes(place / "rivers.csv");
    std::string const header = text.substr(0, text.find("\r\n"));
    ASSERT_TRUE(header.ends_with(",geometry")) << header;
    for (std::string const name : {"geometry", "geom", "the_geom", "WKT"}) {
        SCOPED_TRACE(name);
        std::string const file = name + ".csv";
        place.write(file, header.substr(0, header.rfind(',') + 1) + name + text.substr(text.find("\r\n")));
        std::string const crs = " --source-crs EPSG:32631";
        EXPECT_TRUE(test::has(expect_run(place, "check " + file + crs, 0).out, "3 arcs"));
        expect_run(place, "convert " + file + crs + " -o " + name + ".gpkg", 0);
        EXPECT_EQ(heights_in(place / (name + ".gpkg")), (std::vector<double>{90, 60, 80, 60, 60, 20}));
        expect_run(place, "make " + file + " --set network.lines.source_crs=EPSG:32631 --only network -o " + name, 0);
        expect_run(place, "tin " + file + crs + " -o " + name + ".obj", 0);
    }
}

// Law: what convert writes is read back without --schema, whatever columns its source had.
TEST(Convert, FilesWithTheColumnsOfAnotherSchemaAreRecognised) {
    Workplace const place;
    place.write("rivers.geojson", lines);
    std::vector<std::string> const schemas{"native", "taudem", "nhdplus", "hydrorivers", "grass"};
    std::string const options = " --max-upstream 2 -q --json --schema ";
    auto const converted_from = [&](std::string const& input, std::string const& schema, std::string const& output) {
        Outcome const o = expect_run(place, "convert " + input + " -o " + output + options + schema, 0);
        return o.code == 0 ? o.json().at("schema").get<std::string>() : "";
    };
    for (std::string const& first : schemas) {
        converted_from(read_lines, first, first + ".gpkg");
        for (std::string const& second : schemas) {
            std::string const name = first + "_" + second;
            for (std::string const ending : {".gpkg", ".shp"}) {
                EXPECT_EQ(converted_from(first + ".gpkg", second, name + ending), first);
            }
            // With the columns of two schemas beside those of a third.
            std::string const shapefile = name + (second == "native" ? "_arcs.shp" : ".shp");
            EXPECT_EQ(converted_from(shapefile, "grass", name + "_grass.gpkg"), second);
            EXPECT_EQ(converted_from(name + ".gpkg", "taudem", name + "_taudem.shp"), second);
            EXPECT_EQ(converted_from(name + "_grass.gpkg", "native", name + "_g.gpkg"), "grass");
            EXPECT_EQ(converted_from(name + "_taudem.shp", "native", name + "_t.gpkg"), "taudem");
        }
    }
}

TEST(Convert, ColumnsOfNhdPlusKeepTheirValuesUnderAnotherName) {
    Workplace const place;
    expect_run(place, "convert " + samples + "walker_nhdplus.gpkg -o net.shp --schema taudem --max-upstream 2 -q", 0);
    Outcome const back = expect_run(place, "convert net.shp -o back.gpkg --json -q", 0);
    EXPECT_EQ(back.json().at("schema"), "taudem");
    std::map<std::string, int> comids;
    auto const count = [&](std::string const& file, char const* field, int by) {
        auto const data = opened(place / file);
        ASSERT_NE(data, nullptr);
        ASSERT_GE(data->GetLayer(0)->GetLayerDefn()->GetFieldIndex(field), 0) << file;
        for (auto const& row : *data->GetLayer(0)) {
            comids[std::to_string(row->GetFieldAsInteger64(field))] += by;
        }
    };
    count("net.shp", "u_COMID", 1);
    count("back.gpkg", "u_COMID", -1);
    EXPECT_GT(comids.size(), 10U);
    for (auto const& [comid, difference] : comids) {
        EXPECT_EQ(difference, 0) << comid;
    }
}

namespace {

/// The value of a column by COMID, of NHDPlus or of what became of it.
std::map<std::int64_t, double> column_of(fs::path const& file, std::string const& column) {
    auto const data = opened(file);
    std::map<std::int64_t, double> values;
    if (data != nullptr) {
        OGRLayer& layer = *data->GetLayer(0);
        bool const is_ours = layer.GetLayerDefn()->GetFieldIndex("u_COMID") >= 0;
        for (auto const& row : layer) {
            values[row->GetFieldAsInteger64(is_ours ? "u_COMID" : "COMID")] = row->GetFieldAsDouble(column.c_str());
        }
    }
    return values;
}

/// The arcs of each level path.
std::set<std::set<std::int64_t>> level_paths(fs::path const& file, std::map<std::int64_t, double> const& among) {
    std::map<double, std::set<std::int64_t>> paths;
    for (auto const& [comid, path] : column_of(file, "LevelPathI")) {
        if (among.contains(comid)) {
            paths[path].insert(comid);
        }
    }
    std::set<std::set<std::int64_t>> sets;
    for (auto const& [path, arcs] : paths) {
        sets.insert(arcs);
    }
    return sets;
}

/// By how many COMIDs two columns differ.
int differences(std::map<std::int64_t, double> const& given, std::map<std::int64_t, double> const& made) {
    int count = 0;
    for (auto const& [comid, value] : made) {
        count += std::fabs(given.at(comid) - value) > 1e-9 * std::fabs(value) + 1e-9 ? 1 : 0;
    }
    return count;
}

} // namespace

TEST(Convert, DividedRiversOfNhdPlusKeepTheirHydrography) {
    Workplace const place;
    fs::path const given = fs::path(samples) / "new_hope_nhdplus.gpkg";
    std::string const source = given.string();
    auto const json = expect_run(place, "convert " + source + " -o all.gpkg --schema nhdplus --json", 0).json();
    EXPECT_EQ(json.at("divergences"), 84);
    expect_refused(place, "convert " + source + " -o native.gpkg", {"2 arcs leave", "--fix"});
    Outcome const mended = expect_run(place, "check " + source + " --fix mended.gpkg --json", 3);
    EXPECT_FALSE(test::has(mended.out, "area_raised"));
    Outcome const checked = expect_run(place, "check mended.gpkg --json", 0);
    EXPECT_TRUE(test::has(checked.out, "areas_overlap"));
    expect_run(place, "convert mended.gpkg -o tree.gpkg --schema nhdplus", 0);
    for (auto const& [file, arcs, paths] : {std::tuple("all.gpkg", 746U, 228U), std::tuple("tree.gpkg", 570U, 144U)}) {
        fs::path const made = place / file;
        auto const areas = column_of(made, "TotDASqKM");
        EXPECT_EQ(areas.size(), arcs);
        EXPECT_NEAR(areas.at(8897784), 595.3383, 1e-9) << "at the outlet";
        for (char const* const column : {"TotDASqKM", "AreaSqKM", "StreamOrde", "StreamCalc", "StartFlag"}) {
            EXPECT_EQ(differences(column_of(given, column), column_of(made, column)), 0) << file << " " << column;
        }
        EXPECT_EQ(level_paths(made, areas), level_paths(given, areas)) << file;
        EXPECT_EQ(level_paths(made, areas).size(), paths) << file;
        EXPECT_EQ(column_of(made, "MAXELEVSMO").at(8897784), -9998.0) << "unknown";
        EXPECT_EQ(column_of(made, "SLOPE").at(8897784), -9998.0);
    }
    for (char const* const column : {"Divergence", "RtnDiv"}) {
        EXPECT_EQ(differences(column_of(given, column), column_of(place / "all.gpkg", column)), 0) << column;
    }
    // By length instead, other rivers are main stems.
    expect_run(place, "convert mended.gpkg -o length.gpkg --schema nhdplus --main length", 0);
    auto const among = column_of(place / "length.gpkg", "TotDASqKM");
    EXPECT_NE(level_paths(place / "length.gpkg", among), level_paths(given, among));
}

TEST(Convert, AreasOfCatchmentsStayWhereTotalsAreUnknown) {
    Workplace const place;
    fs::path const given = fs::path(samples) / "coastal_nhdplus.gpkg";
    expect_run(place, "convert " + given.string() + " -o coast.gpkg --schema nhdplus", 0);
    auto const areas = column_of(place / "coast.gpkg", "AreaSqKM");
    auto const before = column_of(given, "AreaSqKM");
    std::int64_t kept = 0;
    for (auto const& [id, area] : areas) {
        EXPECT_EQ(area, before.at(id)) << id;
        kept += area > 0.0 ? 1 : 0;
    }
    EXPECT_GT(kept, 100);
}

TEST(Convert, JsonTellsWhatBecameOfIt) {
    Workplace const place;
    place.write("rivers.geojson", lines);
    auto const json = expect_run(place, "convert " + read_lines + "-o a.gpkg --max-upstream 2 --json", 0).json();
    EXPECT_EQ(json.at("written"), (std::vector<std::string>{"a.gpkg"}));
    EXPECT_EQ(json.at("split"), 1);
    EXPECT_EQ(json.at("arcs"), 7);
    EXPECT_EQ(json.at("heights"), "none");
    EXPECT_EQ(json.at("areas"), "none");
}

TEST(Convert, HeightsAndAreasComeFromADem) {
    Workplace const place;
    place.write("rivers.geojson", lines);
    thalweg::Grid const grid{100, 100, 10.0, 0.0, 1000.0, "EPSG:32631"}; // falls to the south, a metre a row
    auto const plane = test::raster_of(grid, [](thalweg::Cell c) { return 100.0 - static_cast<double>(c.row); });
    thalweg::io::write_dem(plane, (place / "dem.tif").string());
    auto const json = expect_run(place, "convert " + read_lines + "-o a.csv --dem dem.tif --json", 0).json();
    EXPECT_EQ(json.at("heights"), "dem");
    EXPECT_EQ(json.at("areas"), "d8");
    EXPECT_TRUE(test::has(file_bytes(place / "a.csv"), "LINESTRING Z (500 300 30, 500 100 10)"));
    expect_run(place, "convert " + read_lines + "-o a.gpkg --dem dem.tif", 0);
    expect_run(place, "check a.gpkg", 0);
    expect_run(place, "convert " + read_lines + "-o a.tif --dem dem.tif", 0);
    place.shell("gdal_translate -of AAIGrid dem.tif bare.asc && rm bare.prj");
    expect_refused(place, "convert " + read_lines + "-o b.gpkg", {"--dem bare.asc"});
}

TEST(Convert, OverwriteReplacesOnlyWhatItWrites) {
    Workplace const place;
    place.write("rivers.geojson", lines);
    std::string const convert = "convert " + read_lines + "-o a.shp";
    expect_run(place, convert, 0);
    place.write("a_arcs.txt", "mine");
    auto const before = content(place.path());
    expect_run(place, convert, 2);
    EXPECT_TRUE(content(place.path()) == before);
    expect_run(place, convert + " --overwrite", 0);
    EXPECT_TRUE(content(place.path()) == before);
}

TEST(Convert, ADatabaseThatDoesNotAnswerIsAFailure) {
    Workplace const place;
    place.write("rivers.geojson", lines);
    expect_run(place, "convert " + read_lines + "-o \"PG:host='" + place.path().string() + "' dbname=none\"", 1);
}

TEST(Convert, MakeLeavesItsRiversInAnotherSchemaToo) {
    Workplace const place;
    for (std::string const schema : {"taudem", "nhdplus", "hydrorivers", "grass"}) {
        expect_run(
            place,
            "make " + samples +
                "tokunaga.toml --set network.tokunaga.order=3 --set grid.width=100 --set grid.height=100 -q --schema " +
                schema + " -o " + schema,
            0);
        std::string const file = schema + "/network_" + schema + ".gpkg";
        auto const report = expect_run(place, "check " + file + " --json", 0).json();
        EXPECT_EQ(report["schema"], schema);
        auto const native = report_of(place / schema);
        EXPECT_GE(report["arcs"], native["network"]["arcs"]); // taudem splits confluences of three
        expect_run(place, "replay " + schema + " --verify", 0);
    }
}

} // namespace convert_test
