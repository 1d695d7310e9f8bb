// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <map>
#include <string>

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <ogrsf_frmts.h>
#include <support.hpp>

#include "command.hpp"
#include "refused.hpp"
#include "report.hpp"

namespace convert_test {

namespace fs = std::filesystem;

namespace {

/// Three rivers that meet, without heights; a fourth joins below. Drawn by hand, known to nobody's schema.
char const* const lines = R"({"type": "FeatureCollection",
"crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32631"}}, "features": [
{"type": "Feature", "properties": {"nr": 11, "into": 14}, "geometry": {"type": "LineString", "coordinates": [[400, 900], [500, 500]]}},
{"type": "Feature", "properties": {"nr": 12, "into": 14}, "geometry": {"type": "LineString", "coordinates": [[500, 900], [500, 500]]}},
{"type": "Feature", "properties": {"nr": 13, "into": 14}, "geometry": {"type": "LineString", "coordinates": [[600, 900], [500, 500]]}},
{"type": "Feature", "properties": {"nr": 14, "into": 16}, "geometry": {"type": "LineString", "coordinates": [[500, 500], [500, 300]]}},
{"type": "Feature", "properties": {"nr": 15, "into": 16}, "geometry": {"type": "LineString", "coordinates": [[800, 500], [500, 300]]}},
{"type": "Feature", "properties": {"nr": 16, "into": 0}, "geometry": {"type": "LineString", "coordinates": [[500, 300], [500, 100]]}}]})";

std::string const read_lines = "rivers.geojson --field arc_id=nr --field ds_arc=into ";

/// The arcs of a GeoPackage in thalweg's own columns, but for what tells from which file they came.
std::string network_in(fs::path const& gpkg) {
    GDALAllRegister();
    GDALDatasetUniquePtr const data(GDALDataset::Open(gpkg.c_str(), GDAL_OF_VECTOR));
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

/// A plane that falls to the south, a metre a row.
std::string plane() {
    std::string text = "ncols 100\nnrows 100\nxllcorner 0\nyllcorner 0\ncellsize 10\nNODATA_value -9999\n";
    for (int row = 0; row < 100; ++row) {
        for (int col = 0; col < 100; ++col) {
            text += std::to_string(100 - row) + " ";
        }
        text += "\n";
    }
    return text;
}

void write_plane(Workplace const& place) {
    place.write("dem.asc", plane());
    place.write("dem.prj",
                "PROJCS[\"WGS 84 / UTM zone 31N\",GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,"
                "298.257223563]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],PROJECTION["
                "\"Transverse_Mercator\"],PARAMETER[\"latitude_of_origin\",0],PARAMETER[\"central_meridian\",3],"
                "PARAMETER[\"scale_factor\",0.9996],PARAMETER[\"false_easting\",500000],PARAMETER[\"false_northing\",0]"
                ",UNIT[\"metre\",1],AUTHORITY[\"EPSG\",\"32631\"]]");
}

void refused(Workplace const& place, std::string const& arguments, std::string const& words) {
    expect_refused(place, "convert " + arguments, words);
}

} // namespace

TEST(Convert, RefusesWhatCannotBeAndLeavesNothing) {
    Workplace const place;
    place.write("rivers.geojson", lines);
    place.write("taken.gpkg", "mine");
    refused(place, "", "NETWORK");
    refused(place, "rivers.geojson", "--output");
    refused(place, "nowhere.gpkg -o a.gpkg", "nowhere.gpkg");
    refused(place, read_lines + "-o a.kml", "gpkg");
    refused(place, read_lines + "-o none/a.gpkg", "there is no folder");
    refused(place, read_lines + "-o taken.gpkg", "already exists");
    refused(place, read_lines + "-o a.gpkg --schema taudems", "taudem");
    refused(place, read_lines + "-o a.gpkg --schema taudem", "--max-upstream 2");
    refused(place, read_lines + "-o a.gpkg --max-upstream 1", "--max-upstream");
    refused(place, read_lines + "-o a.tif", "a raster needs cells: give --dem or --cell");
    refused(place, read_lines + "-o rivers.geojson --schema grass --overwrite", "may be the input");
    fs::create_directory(place / "folder");
    refused(place, "folder/arcs.shp -o folder/nodes.shp --schema grass", "folder/arcs.shp");
    refused(place, "PG:dbname=x -o PG:dbname=x --overwrite", "the output is the input database");
    refused(place, "rivers.geojson --field nr -o a.gpkg", "QUANTITY=NAME");
    refused(place, read_lines + "-o PG:dbname=x --table 'a; drop table b'", "is not a valid table name");
}

TEST(Convert, ForeignLinesBecomeEverySchemaAndFormat) {
    Workplace const place;
    place.write("rivers.geojson", lines);
    for (std::string const schema : {"native", "taudem", "nhdplus", "hydrorivers", "grass"}) {
        for (std::string const ending : {"gpkg", "shp", "fgb", "geojson", "graphml", "csv", "edges", "tif"}) {
            std::string const name = schema + "." + ending;
            Outcome const outcome = expect_run(
                place,
                "convert " + read_lines + "-o " + name + " --schema " + schema + " --max-upstream 2 --cell 10 -q", 0);
            EXPECT_EQ(outcome.err, "");
            bool const two_files = schema == "native" && (ending == "shp" || ending == "fgb" || ending == "geojson");
            std::string const first = two_files ? schema + "_arcs." + ending : name;
            EXPECT_TRUE(test::has(outcome.out, first + "\n"));
            if (ending == "graphml" || ending == "csv" || ending == "edges" || ending == "tif") {
                continue;
            }
            // And back: the network is the same.
            Outcome const back =
                thalweg_run("convert " + first + " -o back_" + schema + "_" + ending + ".gpkg --json -q", place.path());
            ASSERT_EQ(back.code, 0) << name << back.err;
            auto const json = nlohmann::json::parse(back.out);
            EXPECT_EQ(json.at("schema"), schema);
            EXPECT_EQ(json.at("arcs"), 7);
            EXPECT_EQ(json.at("nodes"), 8);
            EXPECT_EQ(json.at("crs"), "EPSG:32631");
        }
    }
    EXPECT_EQ(file_bytes(place / "rivers.geojson"), lines);
    // From whatever schema: the same network.
    EXPECT_EQ(thalweg_run("check back_native_gpkg.gpkg", place.path()).code, 0);
    // The columns of each format's file come along as the user's, so files differ in them alone.
    EXPECT_EQ(network_in(place / "back_taudem_gpkg.gpkg"), network_in(place / "back_taudem_fgb.gpkg"));
    EXPECT_EQ(network_in(place / "back_grass_shp.gpkg"), network_in(place / "back_grass_geojson.gpkg"));
}

// Law: what convert writes is read back without --schema, whatever columns its source had.
TEST(Convert, FilesWithTheColumnsOfAnotherSchemaAreRecognised) {
    Workplace const place;
    place.write("rivers.geojson", lines);
    std::vector<std::string> const schemas{"native", "taudem", "nhdplus", "hydrorivers", "grass"};
    std::string const options = " --max-upstream 2 -q --json --schema ";
    auto const converted_from = [&](std::string const& input, std::string const& schema, std::string const& output) {
        Outcome const o = expect_run(place, "convert " + input + " -o " + output + options + schema, 0);
        return o.code == 0 ? nlohmann::json::parse(o.out).at("schema").get<std::string>() : "";
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
    std::string const walker = THALWEG_SOURCE_DIR "/samples/walker_nhdplus.gpkg";
    ASSERT_EQ(thalweg_run("convert '" + walker + "' -o net.shp --schema taudem --max-upstream 2 -q", place.path()).code,
              0);
    Outcome const back = expect_run(place, "convert net.shp -o back.gpkg --json -q", 0);
    EXPECT_EQ(nlohmann::json::parse(back.out).at("schema"), "taudem");
    std::map<std::string, int> comids;
    GDALAllRegister();
    auto const count = [&](std::string const& file, char const* field, int by) {
        GDALDatasetUniquePtr const data(GDALDataset::Open((place / file).c_str(), GDAL_OF_VECTOR));
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

TEST(Convert, JsonTellsWhatBecameOfIt) {
    Workplace const place;
    place.write("rivers.geojson", lines);
    Outcome const outcome = expect_run(place, "convert " + read_lines + "-o a.gpkg --max-upstream 2 --json", 0);
    auto const json = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(json.at("written"), (std::vector<std::string>{"a.gpkg"}));
    EXPECT_EQ(json.at("split"), 1);
    EXPECT_EQ(json.at("arcs"), 7);
    EXPECT_EQ(json.at("heights"), "none");
    EXPECT_EQ(json.at("areas"), "none");
    EXPECT_TRUE(test::has(outcome.err, "--dem"));
}

TEST(Convert, HeightsAndAreasComeFromADem) {
    Workplace const place;
    place.write("rivers.geojson", lines);
    write_plane(place);
    Outcome const outcome = expect_run(place, "convert " + read_lines + "-o a.csv --dem dem.asc --json", 0);
    auto const json = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(json.at("heights"), "dem");
    EXPECT_EQ(json.at("areas"), "d8");
    std::string const csv = file_bytes(place / "a.csv");
    EXPECT_TRUE(test::has(csv, "LINESTRING Z (500 300 30, 500 100 10)"));
    ASSERT_EQ(thalweg_run("convert " + read_lines + "-o a.gpkg --dem dem.asc", place.path()).code, 0);
    EXPECT_EQ(thalweg_run("check a.gpkg", place.path()).code, 0);
    ASSERT_EQ(thalweg_run("convert " + read_lines + "-o a.tif --dem dem.asc", place.path()).code, 0);
    place.write("dem.prj", "");
    refused(place, read_lines + "-o b.gpkg --dem dem.asc", "dem.asc");
}

TEST(Convert, OverwriteReplacesOnlyWhatItWrites) {
    Workplace const place;
    place.write("rivers.geojson", lines);
    std::string const convert = "convert " + read_lines + "-o a.shp";
    ASSERT_EQ(thalweg_run(convert, place.path()).code, 0);
    place.write("a_arcs.txt", "mine");
    auto const before = content(place.path());
    EXPECT_EQ(thalweg_run(convert, place.path()).code, 2);
    EXPECT_TRUE(content(place.path()) == before);
    EXPECT_EQ(thalweg_run(convert + " --overwrite", place.path()).code, 0);
    EXPECT_TRUE(content(place.path()) == before);
}

TEST(Convert, WhatIsNoTreeIsSentToCheck) {
    Workplace const place;
    std::string two_ways(lines);
    two_ways.replace(two_ways.find("[[500, 300], [500, 100]]"), 24, "[[500, 500], [500, 100]]");
    place.write("rivers.geojson", two_ways);
    refused(place, "rivers.geojson --field arc_id=nr --field ds_arc=into -o a.gpkg", "thalweg check");
}

TEST(Convert, ADatabaseThatDoesNotAnswerIsAFailure) {
    Workplace const place;
    place.write("rivers.geojson", lines);
    expect_run(place, "convert " + read_lines + "-o \"PG:host='" + place.path().string() + "' dbname=none\"", 1,
               "cannot be reached");
}

TEST(Convert, MakeLeavesItsRiversInAnotherSchemaToo) {
    Workplace const place;
    std::string const small =
        std::string(THALWEG_SOURCE_DIR) +
        "/samples/tokunaga.toml --set network.tokunaga.order=3 --set grid.width=100 --set grid.height=100";
    for (std::string const schema : {"taudem", "nhdplus", "hydrorivers", "grass"}) {
        expect_run(place, "make " + small + " -q --schema " + schema + " -o " + schema, 0);
        std::string const file = schema + "/network_" + schema + ".gpkg";
        Outcome const checked = expect_run(place, "check " + file + " --json", 0);
        auto const report = nlohmann::json::parse(checked.out);
        EXPECT_EQ(report["schema"], schema);
        auto const native = nlohmann::json::parse(file_bytes(place / (schema + "/report.json")));
        EXPECT_GE(report["arcs"], native["network"]["arcs"]); // taudem splits confluences of three
        EXPECT_EQ(thalweg_run("replay " + schema + " --verify", place.path()).code, 0) << schema;
    }
}

} // namespace convert_test
