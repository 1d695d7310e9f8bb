// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <io/sample_networks.hpp>
#include <io/vector_files.hpp>
#include <support.hpp>

#include "command.hpp"

namespace check_test {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

/// Two tributaries and a river below them, as a GeoPackage and as shapefiles.
void write_network(Workplace const& place) {
    SampleNetwork net;
    auto const west = net.node(500000.0, 4000200.0, 30.0);
    auto const east = net.node(500200.0, 4000200.0, 28.0);
    auto const joint = net.node(500100.0, 4000100.0, 20.0);
    auto const mouth = net.node(500100.0, 4000000.0, 10.0);
    net.arc(west, joint, {{500040.0, 4000150.0}});
    net.arc(east, joint);
    net.arc(joint, mouth, {{500110.0, 4000060.0}, {500095.0, 4000030.0}});
    net.settle();
    thalweg::io::write_geopackage(net.tables(), (place / "net.gpkg").string());
    thalweg::io::write_shapefiles(net.tables(), (place / "net").string());
}

void change(fs::path const& file, std::string const& sql) {
    execute(*opened_to_change(file), sql);
}

/// Makes a GeoPackage of a text with columns WKT, ...
void pack(Workplace const& place, std::string const& text, std::string const& type = "LINESTRING") {
    place.write("rivers.csv", text);
    place.shell(
        "ogr2ogr rivers.gpkg rivers.csv -overwrite -a_srs EPSG:32632 -oo AUTODETECT_TYPE=YES -nln rivers -nlt " + type);
}

std::vector<std::string> kinds(json const& findings) {
    std::vector<std::string> result;
    for (auto const& f : findings) {
        result.push_back(f["kind"]);
    }
    return result;
}

} // namespace

TEST(Check, TauDemsLinksWithoutLengthAreBridged) {
    Workplace const place;
    pack(place, "WKT,LINKNO,DSLINKNO,strmOrder\n"
                "\"LINESTRING (500000 5000000,500100 5002500,500000 5005000)\",0,-1,2\n"
                "\"LINESTRING (500000 5005000,500000 5005000)\",1,0,2\n"
                "\"LINESTRING (500000 5005000,502500 5007000,504000 5009000)\",2,0,1\n"
                "\"LINESTRING (500000 5005000,500100 5007500,500000 5010000)\",3,1,1\n"
                "\"LINESTRING (500000 5005000,497500 5007000,496000 5009000)\",4,1,1\n");
    expect_run(place, "check rivers.gpkg --fix mended.gpkg --json", 0);
    EXPECT_EQ(expect_run(place, "check mended.gpkg --json", 0).json()["arcs"], 4);
    EXPECT_EQ(expect_run(place, "convert rivers.gpkg -o native.gpkg --json", 0).json()["arcs"], 4);
}

TEST(Check, AnEndingInCapitalsIsOne) {
    Workplace const place;
    write_network(place);
    expect_run(place, "check net.gpkg --fix MENDED.GPKG --findings FOUND.GPKG", 0);
    EXPECT_TRUE(fs::exists(place / "MENDED.GPKG") && fs::exists(place / "FOUND.GPKG"));
    expect_run(place, "check MENDED.GPKG", 0);
    expect_run(place, "check net.gpkg --fix MENDED.SHP", 0);
    expect_run(place, "check MENDED_arcs.shp", 0);
    expect_run(place, "convert net.gpkg -o COPY.GPKG", 0);
    EXPECT_TRUE(fs::exists(place / "COPY.GPKG") && !fs::exists(place / "COPY.GPKG.gpkg"));
}

TEST(Check, FixMovesOpenEndsOnly) {
    Workplace const place;
    pack(place, "WKT,part\n"
                "\"LINESTRING (500000 5005000,500000 5002015)\",a\n"
                "\"LINESTRING (497000 5005000,500000 5002015)\",a\n"
                "\"LINESTRING (500000 5002015,500000 5002000)\",a\n"
                "\"LINESTRING (503000 5005000,500000 5002000)\",a\n"
                "\"LINESTRING (500000 5002000,500000 5000000)\",a\n"
                "\"LINESTRING (497000 5002500,499997 5001000)\",a\n");
    auto const mended =
        kinds(thalweg_run("check rivers.gpkg --near 20 --fix mended.gpkg --json", place.path()).json()["mended"]);
    EXPECT_EQ(std::ranges::count(mended, "snapped"), 1);
    EXPECT_EQ(std::ranges::count(mended, "removed"), 0);
    EXPECT_EQ(expect_run(place, "check mended.gpkg --json", 0).json()["arcs"], 7);
}

TEST(Check, AMendedCopyKeepsEveryCurve) {
    Workplace const place;
    pack(place,
         "WKT,part\n"
         "\"CIRCULARSTRING (500000 5010000,500400 5007500,500000 5005000)\",a\n"
         "\"COMPOUNDCURVE (CIRCULARSTRING (504000 5010000,503000 5008000,502000 5007000),"
         "(502000 5007000,500000 5005000))\",a\n"
         "\"MULTICURVE ((500000 5005000,500100 5002000,500000 5000000))\",a\n",
         "GEOMETRY");
    EXPECT_EQ(expect_run(place, "check rivers.gpkg --fix mended.gpkg --json", 0).json()["arcs"], 3);
    json const again = expect_run(place, "check mended.gpkg --json", 0).json();
    EXPECT_EQ(again["arcs"], 3);
    EXPECT_EQ(again["nodes"], 4);
}

TEST(Check, ACleanFileIsOk) {
    Workplace const place;
    write_network(place);
    auto const before = content(place.path());
    for (std::string const name : {"net.gpkg", "net_arcs.shp", "net_nodes.shp"}) {
        json const report = expect_run(place, "check --json " + name, 0).json();
        EXPECT_EQ(report["ok"], true);
        EXPECT_EQ(report["arcs"], 3);
        EXPECT_EQ(report["nodes"], 4);
        EXPECT_EQ(report["schema"], "native");
        EXPECT_TRUE(report["findings"].empty()) << report;
        EXPECT_TRUE(report["written"].empty());
    }
    EXPECT_EQ(content(place.path()), before);
}

TEST(Check, AFaultIsReportedMendedAndDrawn) {
    Workplace const place;
    write_network(place);
    change(place / "net.gpkg", "UPDATE arcs SET strahler = 7 WHERE arc_id = 2");
    auto const before = content(place.path());
    Outcome const o = expect_run(place, "check net.gpkg --json --fix sound.gpkg --findings check.gpkg", 3);
    json const report = o.json();
    EXPECT_EQ(report["ok"], false);
    EXPECT_EQ(kinds(report["findings"]), std::vector<std::string>{"strahler_mismatch"});
    EXPECT_EQ(report["findings"][0]["feature"], 2);
    EXPECT_EQ(report["findings"][0]["amount"], 1.0);
    EXPECT_EQ(kinds(report["mended"]), std::vector<std::string>{"mended"});
    EXPECT_EQ(report["written"].size(), 2U);
    expect_run(place, "check sound.gpkg", 0);
    auto after = content(place.path());
    after.erase("sound.gpkg");
    after.erase("check.gpkg");
    EXPECT_EQ(after, before) << "the input is as it was, and nothing else is left";

    auto const layer = opened(place / "check.gpkg");
    ASSERT_NE(layer, nullptr);
    OGRLayer* const findings = layer->GetLayerByName("findings");
    ASSERT_NE(findings, nullptr);
    ASSERT_EQ(findings->GetFeatureCount(), 1);
    OGRFeatureUniquePtr const f(findings->GetNextFeature());
    EXPECT_STREQ(f->GetFieldAsString("kind"), "strahler_mismatch");
    EXPECT_EQ(f->GetFieldAsInteger64("feature"), 2);
    EXPECT_EQ(f->GetFieldAsDouble("amount"), 1.0);
    EXPECT_EQ(f->GetGeometryRef()->toPoint()->getX(), 500200.0);
    EXPECT_NE(findings->GetSpatialRef(), nullptr);
}

TEST(Check, AMendedShapefile) {
    Workplace const place;
    write_network(place);
    change(place / "net.gpkg", "UPDATE arcs SET to_node = 1 WHERE arc_id = 3");
    Outcome const o = expect_run(place, "check net.gpkg --fix sound.shp", 3);
    EXPECT_TRUE(test::has(o.out, "sound_arcs.shp"));
    expect_run(place, "check sound_arcs.shp", 0);
}

TEST(Check, WhatCannotBeMendedIsNotWritten) {
    Workplace const place;
    write_network(place);
    change(place / "net.gpkg", "DELETE FROM arcs");
    Outcome const o = expect_run(place, "check net.gpkg --json --fix sound.gpkg", 3);
    json const report = o.json();
    EXPECT_EQ(kinds(report["mended"]), std::vector<std::string>{"not_mended"});
    EXPECT_TRUE(report["written"].empty());
    EXPECT_FALSE(fs::exists(place / "sound.gpkg"));
}

TEST(Check, TheInputIsNeverAnOutput) {
    Workplace const place;
    write_network(place);
    place.write("there.gpkg", "mine");
    expect_refused(place, "check",
                   {"net.gpkg --fix net.gpkg --overwrite", "net.gpkg --findings net.gpkg --overwrite",
                    "net_arcs.shp --fix net.shp --overwrite", "net_nodes.shp --fix net_arcs.shp --overwrite",
                    "net.gpkg --fix there.gpkg", "net.gpkg --fix sound.tif", "net.gpkg --findings sound.shp",
                    "net.gpkg --near -1", "net.gpkg --schema wombat", "net.gpkg --field arc_id"});
    change(place / "net.gpkg", "UPDATE arcs SET shreve = 7 WHERE arc_id = 2");
    expect_run(place, "check net.gpkg --fix there.gpkg --overwrite", 3);
    expect_run(place, "check there.gpkg", 0);
}

TEST(Check, ForgedColumnsAreFound) {
    std::map<std::string, std::vector<std::string>> const forged = {
        {"arcs",
         {"n_up", "topo_ord", "hack", "length", "length_3d", "straight", "z_up", "z_down", "dist_out", "slope",
          "us_area"}},
        {"nodes", {"deg_in", "deg_out", "basin_id", "strahler", "z", "dist_out", "area"}}};
    Workplace const place;
    write_network(place);
    expect_run(place, "check net.gpkg", 0);
    for (auto const& [layer, columns] : forged) {
        for (std::string const& column : columns) {
            fs::copy_file(place / "net.gpkg", place / "forged.gpkg", fs::copy_options::overwrite_existing);
            std::string const by = column == "us_area" ? " + 1e9" : " + 7";
            change(place / "forged.gpkg", "UPDATE " + layer + " SET " + column + " = " + column + by);
            Outcome const o = expect_run(place, "check forged.gpkg --json", 3);
            std::string const kind = layer == "arcs" ? "column_mismatch" : "node_column_mismatch";
            EXPECT_TRUE(test::has(o.out, kind)) << column;
            bool const named = o.out.find("its " + column + " is") != std::string::npos ||
                               (column == "us_area" && o.out.find("its ds_area is") != std::string::npos);
            EXPECT_TRUE(named) << column;
        }
    }
    change(place / "net.gpkg", "UPDATE nodes SET kind = 'source'");
    expect_run(place, "check net.gpkg", 3);
}

} // namespace check_test
