// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// GDAL ends a layer where it cannot read on, as if there were no more features: what looks into one asks why.
#include <thalweg/io/network/read_network.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <ogrsf_frmts.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/crs/internal/units.hpp>
#include <thalweg/io/gdal/sources.hpp>
#include <thalweg/io/network/internal/line_features.hpp>
#include <thalweg/io/network/read_rivers.hpp>
#include <thalweg/io/network/write_network.hpp>

#include "sample_networks.hpp"
#include "scratch_folder.hpp"
#include "vector_files.hpp"

namespace read_network_test {

using namespace thalweg;
using namespace thalweg::io;

namespace {

using test::has;
using test::message_of;
namespace fs = std::filesystem;

std::string refusal(std::string const& path) {
    return message_of<BadInput>([&] { io::read_network(path); });
}

// A GeoPackage of Y shape, changed by SQL.
std::string changed(ScratchFolder const& folder, std::vector<std::string> const& statements) {
    SampleNetwork const sample = y_shape();
    std::string const path = folder / "net.gpkg";
    io::write_geopackage(sample.tables(), path);
    std::unique_ptr<GDALDataset> const dataset(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_UPDATE));
    for (std::string const& statement : statements) {
        dataset->ReleaseResultSet(dataset->ExecuteSQL(statement.c_str(), nullptr, nullptr));
    }
    return path;
}

// A shapefile pair of one node and one arc, whose arc and fields the test makes.
std::string hand_made(ScratchFolder const& folder, OGRwkbGeometryType type, std::string const& arc_wkt,
                      std::function<void(OGRFeature&)> const& fill, OGRFieldType id_type = OFTInteger) {
    GDALAllRegister();
    auto* const driver = GetGDALDriverManager()->GetDriverByName("GPKG");
    std::string const path = folder / "hand.gpkg";
    std::unique_ptr<GDALDataset> const dataset(driver->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    auto const feature_in = [&](char const* name, OGRwkbGeometryType layer_type, std::vector<char const*> const& fields,
                                std::string const& wkt, std::function<void(OGRFeature&)> const& set) {
        OGRLayer& layer = *dataset->CreateLayer(name, nullptr, layer_type, nullptr);
        for (char const* const field_name : fields) {
            OGRFieldDefn field(field_name, id_type);
            layer.CreateField(&field);
        }
        OGRFeature feature(layer.GetLayerDefn());
        for (int i = 0; i < feature.GetFieldCount(); ++i) {
            feature.SetField(i, 1);
        }
        set(feature);
        OGRGeometry* shape = nullptr;
        OGRGeometryFactory::createFromWkt(wkt.c_str(), nullptr, &shape);
        feature.SetGeometryDirectly(shape);
        EXPECT_EQ(layer.CreateFeature(&feature), OGRERR_NONE);
    };
    feature_in("nodes", wkbPoint25D, {"node_id"}, "POINT Z (0 0 0)", [](OGRFeature&) {});
    feature_in("arcs", type, {"arc_id", "from_node", "to_node", "ds_arc", "strahler", "shreve", "basin_id"}, arc_wkt,
               fill);
    return path;
}

void leave(OGRFeature& /*feature*/) {}

// Two sources meet at (100, 100); the outlet is at (100, 0).
ForeignLayer rivers() {
    return {.name = "rivers",
            .type = wkbUnknown,
            .fields = {{"HYRIV_ID", OFTInteger}, {"NEXT_DOWN", OFTInteger}, {"ORD_STRA", OFTInteger}},
            .rows = {{"LINESTRING Z (50 200 3, 100 100 2)", {"1", "3", "1"}},
                     {"LINESTRING Z (150 200 3, 100 100 2)", {"2", "3", "1"}},
                     {"LINESTRING Z (100 100 2, 100 0 1)", {"3", "0", "2"}}}};
}

NetworkFile read_back(ForeignLayer const& layer) {
    ScratchFolder const folder;
    return io::read_network(written(folder, "r.gpkg", "GPKG", {layer}), io::ReadNetworkParams{});
}

// The words of the error; "" when there is none.
std::string failure(std::string const& path, io::ReadNetworkParams const& params = {}) {
    return message_of([&] { io::read_network(path, params); });
}

std::unique_ptr<GDALDataset> opened_to_change(std::string const& path) {
    return std::unique_ptr<GDALDataset>(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_UPDATE));
}

void execute(GDALDataset& dataset, char const* sql) {
    dataset.ReleaseResultSet(dataset.ExecuteSQL(sql, nullptr, nullptr));
}

/// A GeoPackage whose page of features is overwritten.
std::string damaged(ScratchFolder const& folder, OGRwkbGeometryType type) {
    std::string const marker = "a feature of the damaged page";
    std::string const path = written(folder, "damaged.gpkg", "GPKG",
                                     {{.name = "rivers",
                                       .type = type,
                                       .fields = {{"z_unit", OFTString}},
                                       .rows = {{"LINESTRING Z (0 0 3,9 9 1)", {marker}}}}});
    std::string bytes = bytes_of(path);
    constexpr std::size_t page = 4096;
    std::size_t const at = bytes.find(marker);
    EXPECT_NE(at, std::string::npos);
    bytes.replace(at / page * page, page, std::string(page, '\x5a'));
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
}

using Data = std::unique_ptr<GDALDataset>;

Data opened(std::string const& path) {
    GDALAllRegister();
    return Data(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR));
}

} // namespace

TEST(ReadNetwork, MissingFileAndEmptyFolder) {
    ScratchFolder const folder;
    EXPECT_TRUE(has(refusal(folder / "none.gpkg"), "does not exist"));
    EXPECT_TRUE(has(refusal(folder.path().string()), "0 files NAME_arcs.shp"));
    std::ofstream(folder / "text.gpkg") << "no network";
    EXPECT_TRUE(has(refusal(folder / "text.gpkg"), "cannot be read"));
    std::ofstream(folder / "rivers.shp") << "no network";
    EXPECT_TRUE(has(refusal(folder / "rivers.shp"), "neither NAME_arcs.shp nor NAME_nodes.shp"));
}

TEST(ReadNetwork, EveryNameOfANetworkReadsTheSame) {
    ScratchFolder const folder;
    SampleNetwork const sample = two_basins();
    std::filesystem::create_directory(folder / "both");
    std::filesystem::create_directory(folder / "shapes");
    io::write_geopackage(sample.tables(), folder / "both/network.gpkg");
    io::write_shapefiles(sample.tables(), folder / "shapes/net");
    for (std::string const name :
         {"both", "both/network.gpkg", "shapes", "shapes/net_arcs.shp", "shapes/net_nodes.shp"}) {
        NetworkFile const file = io::read_network(folder / name);
        ASSERT_EQ(file.nodes.size(), 8U) << name;
        ASSERT_EQ(file.arcs.size(), 6U) << name;
        EXPECT_EQ(file.arcs[3].strahler, 2);
        EXPECT_EQ(file.arcs[3].shreve, 3);
        EXPECT_EQ(file.arcs[3].from_node, 3);
        EXPECT_EQ(file.arcs[3].to_node, 2);
        EXPECT_EQ(file.arcs[3].ds_arc, 5);
        EXPECT_EQ(file.arcs[5].basin, 2);
        EXPECT_EQ(file.arcs[5].line.back(), (Vec3{1000.1, 0.0, 3.0}));
    }
    io::write_shapefiles(sample.tables(), folder / "shapes/second");
    EXPECT_TRUE(has(refusal(folder / "shapes"), "2 files"));
    std::filesystem::remove(folder / "shapes/net_nodes.shp");
    EXPECT_TRUE(has(refusal(folder / "shapes/net_arcs.shp"), "net_nodes.shp does not exist"));
}

TEST(ReadNetwork, BadNumbersInAFileAreReadAsTheyStand) {
    ScratchFolder const folder;
    NetworkFile const file = io::read_network(
        changed(folder, {"UPDATE arcs SET ds_arc = 99, strahler = -7", "UPDATE nodes SET node_id = 1"}));
    EXPECT_EQ(file.arcs[0].ds_arc, 99);
    EXPECT_EQ(file.arcs[0].strahler, -7);
    EXPECT_EQ(file.nodes[3].id, 1);
}

TEST(ReadNetwork, MissingLayerAndMissingFieldsAreNamed) {
    ScratchFolder const one;
    EXPECT_TRUE(has(refusal(changed(one, {"DROP TABLE nodes"})), "no layer nodes"));
    ScratchFolder const two;
    EXPECT_TRUE(has(refusal(changed(two, {"ALTER TABLE arcs DROP COLUMN ds_arc",
                                          "ALTER TABLE arcs RENAME COLUMN shreve TO magnitude"})),
                    "layer arcs: no field ds_arc, shreve"));
}

TEST(ReadNetwork, NumbersMustBeThereAndWhole) {
    ScratchFolder const none;
    EXPECT_TRUE(has(refusal(hand_made(none, wkbLineString25D, "LINESTRING Z (0 0 1, 1 1 0)",
                                      [](OGRFeature& f) { f.SetFieldNull(f.GetFieldIndex("to_node")); })),
                    "feature 1 has no to_node"));
    ScratchFolder const half;
    EXPECT_TRUE(has(refusal(hand_made(
                        half, wkbLineString25D, "LINESTRING Z (0 0 1, 1 1 0)",
                        [](OGRFeature& f) { f.SetField("strahler", 1.5); }, OFTReal)),
                    "strahler 1.5, not a whole number"));
    ScratchFolder const text;
    EXPECT_TRUE(has(refusal(hand_made(text, wkbLineString25D, "LINESTRING Z (0 0 1, 1 1 0)", leave, OFTString)),
                    "arc_id holds text, which is read as numbers"));
    ScratchFolder const whole;
    EXPECT_EQ(io::read_network(hand_made(
                                   whole, wkbLineString25D, "LINESTRING Z (0 0 1, 1 1 0)",
                                   [](OGRFeature& f) { f.SetField("strahler", 3.0); }, OFTReal))
                  .arcs[0]
                  .strahler,
              3);
}

TEST(ReadNetwork, ShapesMustBeLinesWithZ) {
    ScratchFolder const flat;
    EXPECT_TRUE(has(refusal(hand_made(flat, wkbLineString, "LINESTRING (0 0, 1 1)", leave)), "has no heights (Z)"));
    ScratchFolder const polygon;
    EXPECT_TRUE(has(refusal(hand_made(polygon, wkbPolygon25D, "POLYGON Z ((0 0 0, 1 1 0, 1 0 0, 0 0 0))", leave)),
                    "is not a line"));
    ScratchFolder const parts;
    EXPECT_TRUE(has(
        refusal(hand_made(parts, wkbMultiLineString25D, "MULTILINESTRING Z ((0 0 1, 1 1 0), (2 2 1, 3 3 0))", leave)),
        "has 2 parts"));
    ScratchFolder const one;
    EXPECT_EQ(io::read_network(hand_made(one, wkbMultiLineString25D, "MULTILINESTRING Z ((0 0 1, 1 1 0))", leave))
                  .arcs[0]
                  .line,
              (std::vector<Vec3>{{0, 0, 1}, {1, 1, 0}}));
    ScratchFolder const empty;
    EXPECT_TRUE(io::read_network(hand_made(empty, wkbLineString25D, "LINESTRING Z EMPTY", leave)).arcs[0].line.empty());
}

TEST(ReadNetwork, DamagedFileIsNotReadInPart) {
    SampleNetwork sample;
    auto below = sample.node(0.0, 0.0, 0.0);
    for (int i = 1; i < 3000; ++i) {
        auto const above = sample.node(i * 1.5, i * 0.5, i);
        sample.arc(above, below);
        below = above;
    }
    sample.settle();
    ScratchFolder const folder;
    std::string const path = folder / "net.gpkg";
    io::write_geopackage(sample.tables(), path);
    auto const size = std::filesystem::file_size(path);
    int refused = 0;
    for (double const share : {0.2, 0.3, 0.4, 0.5, 0.6}) {
        std::string const copy = folder / "damaged.gpkg";
        std::filesystem::copy_file(path, copy, std::filesystem::copy_options::overwrite_existing);
        std::fstream file(copy, std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(static_cast<std::streamoff>(share * static_cast<double>(size)) / 4096 * 4096);
        file << std::string(3 * 4096, '\x55');
        file.close();
        try {
            NetworkFile const read = io::read_network(copy);
            EXPECT_EQ(read.arcs.size(), 2999U);
            EXPECT_EQ(read.nodes.size(), 3000U);
        } catch (Error const&) {
            ++refused;
        }
    }
    EXPECT_GE(refused, 2);
    std::filesystem::resize_file(path, size / 2);
    EXPECT_THROW(io::read_network(path), Error);
}

TEST(BadNetwork, CleanFileHasNoFindings) {
    NetworkFile const file = read_back(rivers());
    EXPECT_TRUE(file.findings.empty()) << file.findings.front().text;
    EXPECT_TRUE(file.says.heights);
    EXPECT_EQ(file.nodes[1].at, (Vec3{100, 100, 2}));
}

TEST(BadNetwork, PartsThatJoinAreOneLineWhateverTheirOrder) {
    ForeignLayer layer = rivers();
    layer.rows[1].first =
        "MULTILINESTRING Z ((130 150 2.5, 110 120 2.2),(110 120 2.2, 100 100 2),(150 200 3, 130 150 2.5))";
    NetworkFile const file = read_back(layer);
    ASSERT_EQ(file.arcs.size(), 3U);
    EXPECT_EQ(file.arcs[1].line, (std::vector<Vec3>{{150, 200, 3}, {130, 150, 2.5}, {110, 120, 2.2}, {100, 100, 2}}));
    Finding const finding = finding_of(file, "multi_part");
    EXPECT_EQ(finding.feature, 2);
    EXPECT_EQ(finding.amount, 3.0);
    EXPECT_EQ(finding.where, (Vec2{150, 200}));
    EXPECT_TRUE(has(finding.text, "join end to end"));
    EXPECT_EQ(file.findings.size(), 1U);
}

TEST(BadNetwork, PartsThatDoNotJoinAreArcsOfOneId) {
    for (char const* const wkt :
         {"MULTILINESTRING Z ((150 200 3, 130 150 2.5),(110 120 2.2, 100 100 2))",
          "MULTILINESTRING Z ((150 200 3, 130 150 2.5),(130 150 2.5, 100 100 2),(130 150 2.5, 0 0 0))",
          "MULTILINESTRING Z ((150 200 3, 130 150 2.5),(150 200 3, 130 150 2.5))",
          "MULTILINESTRING Z ((150 200 3, 130 150 2.5),(130 150 2.5, 150 200 3))"}) {
        ForeignLayer layer = rivers();
        layer.rows[1].first = wkt;
        NetworkFile const file = read_back(layer);
        EXPECT_GE(std::ranges::count(file.arcs, 2, &NetworkFile::FileArc::id), 2) << wkt;
        EXPECT_EQ(finding_of(file, "multi_part").feature, 2);
        EXPECT_TRUE(has(finding_of(file, "multi_part").text, "an arc of the same id"));
    }
}

TEST(BadNetwork, CurvesBecomeLines) {
    ForeignLayer layer = rivers();
    layer.rows[1].first = "CIRCULARSTRING Z (150 200 3, 140 130 2.5, 100 100 2)";
    NetworkFile const file = read_back(layer);
    EXPECT_GT(file.arcs[1].line.size(), 10U);
    EXPECT_EQ(file.arcs[1].line.front(), (Vec3{150, 200, 3}));
    EXPECT_EQ(file.arcs[1].line.back(), (Vec3{100, 100, 2}));
    EXPECT_EQ(finding_of(file, "curve").feature, 2);
    EXPECT_EQ(finding_of(file, "curve").amount, static_cast<double>(file.arcs[1].line.size()));
}

TEST(BadNetwork, TypesOfCurvesAreLines) {
    std::string const straight = "(150 200 3, 120 150 2.5, 100 100 2)";
    for (std::string const& wkt : {"MULTICURVE Z (" + straight + ")", "COMPOUNDCURVE Z (" + straight + ")",
                                   "MULTICURVE Z (COMPOUNDCURVE Z (" + straight + "))",
                                   "GEOMETRYCOLLECTION Z (MULTICURVE Z (" + straight + "))"}) {
        ForeignLayer layer = rivers();
        layer.type = wkbUnknown;
        layer.rows[1].first = wkt;
        NetworkFile const file = read_back(layer);
        ASSERT_EQ(file.arcs.size(), 3U) << wkt;
        EXPECT_EQ(file.arcs[1].line, (std::vector<Vec3>{{150, 200, 3}, {120, 150, 2.5}, {100, 100, 2}})) << wkt;
        EXPECT_EQ(count_of(file, "curve") + count_of(file, "not_a_line"), 0) << wkt;
    }
    for (std::string const wkt : {"MULTICURVE Z (CIRCULARSTRING Z (150 200 3, 140 130 2.5, 100 100 2))",
                                  "COMPOUNDCURVE Z (CIRCULARSTRING Z (150 200 3, 140 130 2.5, 100 100 2))"}) {
        ForeignLayer layer = rivers();
        layer.type = wkbUnknown;
        layer.rows[1].first = wkt;
        NetworkFile const file = read_back(layer);
        ASSERT_EQ(file.arcs.size(), 3U) << wkt;
        EXPECT_GT(file.arcs[1].line.size(), 10U) << wkt;
        EXPECT_EQ(count_of(file, "curve"), 1) << wkt;
    }
}

TEST(BadNetwork, MeasuresAndMissingHeights) {
    ForeignLayer layer = rivers();
    layer.rows[0].first = "LINESTRING ZM (50 200 3 7, 100 100 2 8)";
    layer.rows[1].first = "LINESTRING M (150 200 7, 100 100 8)";
    NetworkFile const file = read_back(layer);
    EXPECT_EQ(finding_of(file, "measures").amount, 2.0);
    EXPECT_EQ(finding_of(file, "no_heights").amount, 1.0);
    EXPECT_TRUE(has(finding_of(file, "no_heights").text, "feature 2 has no heights (Z)"));
    EXPECT_EQ(file.arcs[0].line.front(), (Vec3{50, 200, 3}));
    EXPECT_TRUE(std::isnan(file.arcs[1].line.front().z));
    EXPECT_TRUE(file.says.heights);     // so that the check finds the arc without
    EXPECT_EQ(file.nodes[1].at.z, 2.0); // as most ends there have it
}

TEST(BadNetwork, FlatLinesHaveNoHeights) {
    ForeignLayer layer = rivers();
    for (auto& [wkt, values] : layer.rows) {
        wkt.erase(wkt.find(" Z"), 2);
        for (char const* const height : {" 3,", " 2)", " 2,", " 1)"}) {
            if (auto const at = wkt.find(height); at != std::string::npos) {
                wkt.erase(at, 2);
            }
        }
    }
    NetworkFile const file = read_back(layer);
    EXPECT_FALSE(file.says.heights);
    EXPECT_EQ(finding_of(file, "no_heights").amount, 3.0);
    EXPECT_EQ(file.nodes.size(), 4U);
}

TEST(BadNetwork, IdsRepeatAsTheyStand) {
    ForeignLayer layer = rivers();
    layer.rows[1].second[0] = "1";
    NetworkFile const file = read_back(layer);
    EXPECT_EQ(file.arcs[0].id, 1);
    EXPECT_EQ(file.arcs[1].id, 1);
    EXPECT_TRUE(file.findings.empty());
}

TEST(BadNetwork, NumbersAsTextAreNumbers) {
    ForeignLayer layer = rivers();
    layer.fields[0].second = OFTString;
    layer.fields[2].second = OFTString;
    layer.rows[2].second[0] = " 3 ";
    layer.rows[1].second[2] = "one";
    NetworkFile const file = read_back(layer);
    EXPECT_EQ(file.arcs[2].id, 3);
    EXPECT_EQ(file.arcs[0].ds_arc, 3);
    EXPECT_EQ(count_of(file, "text_number"), 2);
    EXPECT_EQ(finding_of(file, "not_a_number").feature, 2);
    EXPECT_TRUE(has(finding_of(file, "not_a_number").text, "feature 2 has ORD_STRA one, not a whole number"));
    EXPECT_EQ(file.arcs[1].strahler, 0);
}

TEST(BadNetwork, NullsAreSaidAndStandAsZero) {
    ForeignLayer layer = rivers();
    layer.rows[0].second[0] = "";
    layer.rows[1].second[2] = "";
    layer.rows[2].second[1] = "";
    NetworkFile const file = read_back(layer);
    EXPECT_EQ(file.arcs[0].id, 0);
    EXPECT_EQ(file.arcs[1].strahler, 0);
    EXPECT_EQ(file.arcs[2].ds_arc, 0);
    ASSERT_EQ(count_of(file, "null_number"), 2); // no arc downstream may be null
    EXPECT_TRUE(has(file.findings[0].text, "feature 1 has no HYRIV_ID"));
    EXPECT_EQ(file.findings[1].feature, 2);
}

TEST(BadNetwork, AThousandFindingsOfAKindAreEnough) {
    ForeignLayer layer = rivers();
    layer.rows.clear();
    for (int i = 1; i <= 1500; ++i) {
        std::string const x = std::to_string(i);
        layer.rows.push_back({"LINESTRING Z (" + x + " 10 2, " + x + " 0 1)", {x, "0", ""}});
    }
    NetworkFile const file = read_back(layer);
    EXPECT_EQ(file.findings.size(), 1001U);
    EXPECT_EQ(file.findings.back().amount, 500.0);
}

TEST(BadNetwork, WrongTypesAreRefused) {
    ForeignLayer layer = rivers();
    layer.fields[1].second = OFTDate;
    ScratchFolder const folder;
    EXPECT_TRUE(has(failure(written(folder, "r.gpkg", "GPKG", {layer})), "field NEXT_DOWN does not hold numbers"));
}

TEST(BadNetwork, WhatIsNoLineIsPassedOver) {
    ForeignLayer layer = rivers();
    layer.rows.push_back({"POLYGON ((0 0, 1 0, 1 1, 0 0))", {"4", "0", "1"}});
    layer.rows.push_back({"", {"5", "0", "1"}});
    layer.rows.push_back({"LINESTRING Z EMPTY", {"6", "0", "1"}});
    NetworkFile const file = read_back(layer);
    ASSERT_EQ(file.arcs.size(), 5U);
    EXPECT_TRUE(file.arcs[3].line.empty() && file.arcs[4].line.empty()); // for the check to find
    EXPECT_EQ(file.arcs[4].from_node, 0);
    EXPECT_EQ(finding_of(file, "not_a_line").amount, 1.0);
    EXPECT_EQ(file.nodes.size(), 4U);
}

TEST(BadNetwork, ACrsThatIsMissingCanBeNamed) {
    ForeignLayer layer = rivers();
    layer.epsg = 0;
    ScratchFolder const folder;
    std::string const path = written(folder, "r.gpkg", "GPKG", {layer});
    NetworkFile const bare = io::read_network(path, io::ReadNetworkParams{});
    EXPECT_EQ(bare.crs, "");
    EXPECT_EQ(count_of(bare, "no_crs"), 1);
    NetworkFile const named = io::read_network(path, {.source_crs = "EPSG:32631"});
    EXPECT_EQ(named.crs, "EPSG:32631");
    EXPECT_EQ(count_of(named, "no_crs"), 0);
    EXPECT_EQ(named.arcs[0].line, bare.arcs[0].line);
}

TEST(BadNetwork, CollectionsGiveTheirLines) {
    ForeignLayer layer = rivers();
    layer.type = wkbUnknown;
    std::size_t const before = read_back(layer).arcs.size();
    layer.rows.push_back({"GEOMETRYCOLLECTION (POINT (0 0), LINESTRING (7 7, 8 8), POINT (1 1))", {"4", "0", "1"}});
    layer.rows.push_back({"GEOMETRYCOLLECTION (POINT (0 0), POLYGON ((0 0, 1 0, 1 1, 0 0)))", {"5", "0", "1"}});
    NetworkFile const file = read_back(layer);
    ASSERT_EQ(file.arcs.size(), before + 1);
    EXPECT_EQ(file.arcs.back().line.size(), 2U);
    EXPECT_EQ(count_of(file, "not_a_line"), 2); // a note for each type
    EXPECT_EQ(finding_of(file, "not_a_line").amount, 3.0);
}

TEST(BadNetwork, EmptyLayerIsAnEmptyNetwork) {
    ForeignLayer layer = rivers();
    layer.rows.clear();
    NetworkFile const file = read_back(layer);
    EXPECT_TRUE(file.arcs.empty());
    EXPECT_TRUE(file.nodes.empty());
    EXPECT_EQ(file.schema, "hydrorivers");
}

TEST(BadNetwork, NoCrsIsSaid) {
    ForeignLayer layer = rivers();
    layer.epsg = 0;
    NetworkFile const file = read_back(layer);
    EXPECT_EQ(file.crs, "");
    EXPECT_EQ(count_of(file, "no_crs"), 1);
    EXPECT_EQ(file.arcs[0].line.front(), (Vec3{50, 200, 3}));
}

TEST(BadNetwork, MetresThatAreCalledDegreesAreRefused) {
    ForeignLayer layer = rivers();
    layer.epsg = 4326;
    ScratchFolder const folder;
    EXPECT_TRUE(has(failure(written(folder, "r.gpkg", "GPKG", {layer})), "has no longitude and latitude"));
}

TEST(BadNetwork, AVertexThatIsNowhereIsLeftForTheCheck) {
    ForeignLayer layer = rivers();
    layer.epsg = 4326;
    layer.rows[0].first = "LINESTRING Z (9.5 47.2 3, 9.55 47.1 2)";
    layer.rows[1].first = "LINESTRING Z (9.6 1e300 3, 9.55 47.1 2)";
    layer.rows[2].first = "LINESTRING Z (9.55 47.1 2, 9.55 47.0 1)";
    ScratchFolder const folder;
    EXPECT_TRUE(has(failure(written(folder, "r.gpkg", "GPKG", {layer})), "longitude and latitude"));
    layer.rows[1].first = "LINESTRING Z (9.6 95 3, 9.55 47.1 2)";
    layer.rows.push_back({"LINESTRING Z (9.55 0 3, 9.55 -1 2)", {"4", "0", "1"}}); // so that the middle is on earth
    NetworkFile const file = read_back(layer);
    EXPECT_TRUE(std::isnan(file.arcs[1].line.front().x));
    EXPECT_FALSE(std::isnan(file.arcs[1].line.back().x));
}

TEST(BadNetwork, LayersInDifferentCrsAreRefused) {
    ForeignLayer arcs{.name = "arcs",
                      .type = wkbLineString25D,
                      .fields = {{"arc_id", OFTInteger},
                                 {"from_node", OFTInteger},
                                 {"to_node", OFTInteger},
                                 {"ds_arc", OFTInteger},
                                 {"strahler", OFTInteger},
                                 {"shreve", OFTInteger},
                                 {"basin_id", OFTInteger}},
                      .rows = {{"LINESTRING Z (0 1 1, 0 0 0)", {"1", "1", "2", "0", "1", "1", "1"}}}};
    ForeignLayer nodes{.name = "nodes",
                       .type = wkbPoint25D,
                       .epsg = 32632,
                       .fields = {{"node_id", OFTInteger}},
                       .rows = {{"POINT Z (0 1 1)", {"1"}}, {"POINT Z (0 0 0)", {"2"}}}};
    ScratchFolder const folder;
    EXPECT_TRUE(has(failure(written(folder, "mixed.gpkg", "GPKG", {arcs, nodes})), "reproject both to one CRS"));
    nodes.epsg = 32631;
    NetworkFile const file =
        io::read_network(written(folder, "n.gpkg", "GPKG", {arcs, nodes}), io::ReadNetworkParams{});
    EXPECT_TRUE(file.says.nodes && file.findings.empty());
    // Without nodes, or without the orders, a network in the native schema is still one.
    arcs.fields.resize(4);
    arcs.rows[0].second.resize(4);
    NetworkFile const bare = io::read_network(written(folder, "b.gpkg", "GPKG", {arcs}), io::ReadNetworkParams{});
    EXPECT_EQ(count_of(bare, "missing_nodes"), 1);
    EXPECT_EQ(finding_of(bare, "missing_field").amount, 3.0);
    EXPECT_TRUE(has(finding_of(bare, "missing_field").text, "no field strahler, shreve, basin_id"));
    EXPECT_FALSE(bare.says.nodes || bare.says.strahler || bare.says.shreve || bare.says.basin);
    EXPECT_EQ(bare.nodes.size(), 2U);
    EXPECT_EQ(bare.nodes[0].at, (Vec3{0, 1, 1}));
}

TEST(BadNetwork, NodesLieWhereMostOfTheirEndsAre) {
    ForeignLayer const layer{.name = "edges",
                             .type = wkbLineString25D,
                             .fields = {{"id", OFTInteger}, {"f", OFTInteger}, {"t", OFTInteger}},
                             .rows = {{"LINESTRING Z (50 200 3, 101 100 2)", {"1", "1", "9"}},
                                      {"LINESTRING Z (150 200 3, 100 100 2)", {"2", "2", "9"}},
                                      {"LINESTRING Z (100 100 2, 100 0 1)", {"3", "9", "4"}}}};
    ScratchFolder const folder;
    NetworkFile const file = io::read_network(written(folder, "e.gpkg", "GPKG", {layer}),
                                              {.fields = {{"arc_id", "id"}, {"from_node", "f"}, {"to_node", "t"}}});
    ASSERT_EQ(file.nodes.size(), 4U);
    EXPECT_EQ(file.nodes[3].id, 9);
    EXPECT_EQ(file.nodes[3].at, (Vec3{100, 100, 2}));
}

TEST(BadNetwork, ShapefileInPieces) {
    ForeignLayer layer = rivers();
    layer.type = wkbLineString25D;
    for (std::string const ending : {".shx", ".dbf", ".shp"}) {
        ScratchFolder const folder;
        std::string const path = written(folder, "r.shp", "ESRI Shapefile", {layer});
        fs::remove(folder / ("r" + ending));
        auto const before = state_of(folder);
        std::string const words = failure(path);
        EXPECT_TRUE(has(words, "r.shp")) << ending;
        EXPECT_TRUE(has(words, ending == ".dbf" ? "lost its .dbf" : ending == ".shx" ? "shx" : "does not exist"));
        EXPECT_EQ(state_of(folder), before) << ending;
    }
    for (std::string const ending : {".shx", ".dbf", ".shp"}) {
        ScratchFolder const folder;
        std::string const path = written(folder, "r.shp", "ESRI Shapefile", {layer});
        for (std::uintmax_t const bytes : {fs::file_size(folder / ("r" + ending)) - 20, std::uintmax_t{50}}) {
            fs::resize_file(folder / ("r" + ending), bytes);
            auto const before = state_of(folder);
            EXPECT_FALSE(failure(path).empty()) << ending << " of " << bytes << " bytes";
            EXPECT_EQ(state_of(folder), before) << ending;
        }
    }
    for (std::size_t at = 0; at < 124; at += 3) { // a byte of the .shx gone wrong: an error, or the network
        ScratchFolder const folder;
        std::string const path = written(folder, "r.shp", "ESRI Shapefile", {layer});
        std::fstream file(folder / "r.shx", std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(static_cast<std::streamoff>(at));
        file.put('\x7f');
        file.close();
        try {
            EXPECT_LE(io::read_network(path, io::ReadNetworkParams{}).arcs.size(), 3U);
        } catch (Error const&) {
            SUCCEED();
        }
    }
}

TEST(BadNetwork, ReadingTouchesNothing) {
    for (auto const& [name, driver] : {std::pair("r.gpkg", "GPKG"), std::pair("r.shp", "ESRI Shapefile"),
                                       std::pair("r.fgb", "FlatGeobuf"), std::pair("r.geojson", "GeoJSON")}) {
        ScratchFolder const folder;
        ForeignLayer layer = rivers();
        layer.type = wkbLineString25D;
        std::string const path = written(folder, name, driver, {layer});
        auto const before = state_of(folder);
        EXPECT_EQ(io::read_network(path, io::ReadNetworkParams{}).arcs.size(), 3U) << name;
        EXPECT_EQ(state_of(folder), before) << name;
        fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
        EXPECT_EQ(io::read_network(path, io::ReadNetworkParams{}).arcs.size(), 3U) << name;
        fs::permissions(folder.path(), fs::perms::owner_all);
        EXPECT_EQ(state_of(folder), before) << name;
    }
}

TEST(BadNetwork, AGeoPackageInWriteAheadModeIsNotWritten) {
    ScratchFolder const folder;
    std::string const path = written(folder, "r.gpkg", "GPKG", {rivers()});
    execute(*opened_to_change(path), "PRAGMA journal_mode = WAL");
    auto const closed = state_of(folder);
    EXPECT_EQ(io::read_network(path, io::ReadNetworkParams{}).arcs.size(), 3U);
    EXPECT_EQ(io::dataset_files(path), std::vector{path});
    EXPECT_EQ(state_of(folder), closed);

    auto const writer = opened_to_change(path); // another program that has it open, with changes
    execute(*writer, "UPDATE rivers SET HYRIV_ID = 7 WHERE fid = 1");
    auto const open = state_of(folder);
    EXPECT_EQ(open.size(), 3U); // -wal and -shm too
    NetworkFile const file = io::read_network(path, io::ReadNetworkParams{});
    EXPECT_EQ(file.arcs.size(), 3U);
    EXPECT_EQ(file.arcs[0].id, 7);
    EXPECT_EQ(io::dataset_files(path), (std::vector{path, path + "-wal"})); // the changes belong to it
    EXPECT_EQ(state_of(folder), open);
}

TEST(BadNetwork, WhatIsNamedLikeChangesOfAGeoPackageStays) {
    ScratchFolder const folder;
    std::string const path = written(folder, "r.gpkg", "GPKG", {rivers()});
    std::ofstream(path + "-wal") << "of a copy that was open elsewhere"; // SQLite would delete it
    auto const before = state_of(folder);
    EXPECT_EQ(io::read_network(path, io::ReadNetworkParams{}).arcs.size(), 3U);
    EXPECT_EQ(state_of(folder), before);
}

TEST(BadNetwork, ALockedGeoPackageIsAnError) {
    ScratchFolder const folder;
    std::string const path = written(folder, "r.gpkg", "GPKG", {rivers()});
    auto writer = opened_to_change(path);
    execute(*writer, "BEGIN EXCLUSIVE");
    EXPECT_THROW(io::read_network(path, io::ReadNetworkParams{}), IoError);
    writer.reset();
    EXPECT_EQ(io::read_network(path, io::ReadNetworkParams{}).arcs.size(), 3U);
}

TEST(BadNetwork, DamagedFilesAreErrorsNotCrashes) {
    for (auto const& [name, driver] : {std::pair("r.gpkg", "GPKG"), std::pair("r.fgb", "FlatGeobuf"),
                                       std::pair("r.geojson", "GeoJSON"), std::pair("r.shp", "ESRI Shapefile")}) {
        ScratchFolder const folder;
        ForeignLayer layer = rivers();
        layer.type = wkbLineString25D;
        std::string const path = written(folder, name, driver, {layer});
        std::string const bytes = bytes_of(path);
        int refused = 0;
        for (std::size_t k = 1; k < 24; ++k) {
            std::string broken = bytes;
            if (k % 2 == 0) {
                broken.resize(bytes.size() * k / 24);
            } else {
                broken.replace(bytes.size() * k / 24, 16, std::string(16, '\x55'));
            }
            std::ofstream(path, std::ios::binary) << broken;
            try {
                EXPECT_LE(io::read_network(path, io::ReadNetworkParams{}).arcs.size(), 6U);
            } catch (Error const&) {
                ++refused;
            }
        }
        EXPECT_GE(refused, 5) << name;
    }
}

TEST(BadNetwork, ADatabaseThatIsNotThereIsSaidWithoutItsPassword) {
    std::string const words = failure("PG:host=127.0.0.1 port=1 dbname=rivers user=x password=geheim");
    EXPECT_TRUE(has(words, "dbname=rivers"));
    EXPECT_FALSE(words.find("geheim") != std::string::npos) << words;
    EXPECT_TRUE(has(failure("PG:host=127.0.0.1 port=1 password='ge heim' dbname=rivers"), "cannot be read"));
    EXPECT_FALSE(has(failure("PG:host=127.0.0.1 port=1 password='ge heim' dbname=rivers"), "heim"));
    EXPECT_FALSE(has(failure("postgresql://x:geheim@127.0.0.1:1/rivers"), "geheim"));
}

TEST(DamagedLayers, AreNotTakenForEmptyOnes) {
    ScratchFolder const folder;
    std::string const path = damaged(folder, wkbUnknown);
    EXPECT_THROW(content_of(path), IoError);
    EXPECT_THROW(find_rivers(path), IoError);
    Data const data = opened(path);
    ASSERT_NE(data, nullptr);
    EXPECT_THROW(require_lines(*data, "damaged.gpkg", "io.test"), IoError);
    EXPECT_THROW(rivers_layer(*data, "", "damaged.gpkg", "io.test"), IoError);
}

TEST(DamagedLayers, HeightsAreNotTakenForMetres) {
    ScratchFolder const folder;
    Data const data = opened(damaged(folder, wkbLineString25D));
    ASSERT_NE(data, nullptr);
    EXPECT_THROW(height_unit_of(*data->GetLayer(0)), IoError);
}

} // namespace read_network_test
