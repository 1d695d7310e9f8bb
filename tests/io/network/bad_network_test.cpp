// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/read_network.hpp>

#include <cmath>
#include <fstream>

#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/gdal/sources.hpp>
#include <thalweg/io/network/write_network.hpp>

#include "sample_networks.hpp"
#include "vector_files.hpp"

namespace bad_network_test {

using namespace thalweg;

namespace {

using test::has;
using test::message_of;

namespace fs = std::filesystem;

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
std::string refusal(std::string const& path, io::ReadNetworkParams const& params = {}) {
    return message_of([&] { io::read_network(path, params); });
}

std::unique_ptr<GDALDataset> opened_to_change(std::string const& path) {
    return std::unique_ptr<GDALDataset>(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_UPDATE));
}

void execute(GDALDataset& dataset, char const* sql) {
    dataset.ReleaseResultSet(dataset.ExecuteSQL(sql, nullptr, nullptr));
}

} // namespace

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
    EXPECT_TRUE(has(refusal(written(folder, "r.gpkg", "GPKG", {layer})), "field NEXT_DOWN does not hold numbers"));
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
    EXPECT_TRUE(has(refusal(written(folder, "r.gpkg", "GPKG", {layer})), "has no longitude and latitude"));
}

TEST(BadNetwork, AVertexThatIsNowhereIsLeftForTheCheck) {
    ForeignLayer layer = rivers();
    layer.epsg = 4326;
    layer.rows[0].first = "LINESTRING Z (9.5 47.2 3, 9.55 47.1 2)";
    layer.rows[1].first = "LINESTRING Z (9.6 1e300 3, 9.55 47.1 2)";
    layer.rows[2].first = "LINESTRING Z (9.55 47.1 2, 9.55 47.0 1)";
    ScratchFolder const folder;
    EXPECT_TRUE(has(refusal(written(folder, "r.gpkg", "GPKG", {layer})), "longitude and latitude"));
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
    EXPECT_TRUE(has(refusal(written(folder, "mixed.gpkg", "GPKG", {arcs, nodes})), "reproject both to one CRS"));
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
        std::string const words = refusal(path);
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
            EXPECT_FALSE(refusal(path).empty()) << ending << " of " << bytes << " bytes";
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
    std::string const words = refusal("PG:host=127.0.0.1 port=1 dbname=rivers user=x password=geheim");
    EXPECT_TRUE(has(words, "dbname=rivers"));
    EXPECT_FALSE(words.find("geheim") != std::string::npos) << words;
    EXPECT_TRUE(has(refusal("PG:host=127.0.0.1 port=1 password='ge heim' dbname=rivers"), "cannot be read"));
    EXPECT_FALSE(has(refusal("PG:host=127.0.0.1 port=1 password='ge heim' dbname=rivers"), "heim"));
    EXPECT_FALSE(has(refusal("postgresql://x:geheim@127.0.0.1:1/rivers"), "geheim"));
}

} // namespace bad_network_test
