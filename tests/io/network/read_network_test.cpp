// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// GDAL ends a layer where it cannot read on, as if there were no more features: what looks into one asks why.
#include <thalweg/io/network/read_network.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <string>

#include <gtest/gtest.h>
#include <ogrsf_frmts.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/crs/internal/units.hpp>
#include <thalweg/io/network/internal/read_network.hpp>
#include <thalweg/io/network/read_rivers.hpp>
#include <thalweg/io/network/write_network.hpp>
#include <thalweg/io/sources/sources.hpp>

#include "sample_networks.hpp"
#include "scratch_folder.hpp"
#include "vector_files.hpp"

namespace read_network_test {

using namespace thalweg;
using namespace thalweg::io;

namespace {

using test::error_of;
using test::has;
namespace fs = std::filesystem;

/// Every file of a folder with its bytes and the time it was last written.
std::map<std::string, std::pair<std::string, fs::file_time_type>> state_of(ScratchFolder const& folder) {
    std::map<std::string, std::pair<std::string, fs::file_time_type>> state;
    for (auto const& entry : fs::recursive_directory_iterator(folder.path())) {
        std::string const path = entry.path().string();
        state[path] = {entry.is_regular_file() ? bytes_of(path) : "", entry.last_write_time()};
    }
    return state;
}

/// Reads a network in the native schema, complete.
std::string refusal(std::string const& path) {
    return error_of([&] { io::read_network(path); });
}

/// A GeoPackage of y_shape(), changed by SQL.
std::string changed(ScratchFolder const& folder, std::vector<std::string> const& statements) {
    SampleNetwork const sample = y_shape();
    std::string const path = folder / "net.gpkg";
    io::write_geopackage(sample.tables(), path);
    auto const dataset = opened_to_change(path);
    for (std::string const& statement : statements) {
        execute(*dataset, statement);
    }
    return path;
}

/// One node and one arc in the native schema.
std::vector<ForeignLayer> one_arc(std::string const& wkt = "LINESTRING Z (0 0 1, 1 1 0)",
                                  OGRwkbGeometryType type = wkbLineString25D) {
    return {{.name = "nodes", .type = wkbPoint25D, .fields = "node_id", .rows = {{"POINT Z (0 0 0)", "1"}}},
            {.name = "arcs",
             .type = type,
             .fields = "arc_id from_node to_node ds_arc strahler shreve basin_id",
             .rows = {{wkt, "1|1|1|1|1|1|1"}}}};
}

// Two sources meet at (100, 100); the outlet is at (100, 0).
ForeignLayer rivers() {
    return {.type = wkbUnknown,
            .fields = "HYRIV_ID NEXT_DOWN ORD_STRA",
            .rows = {{"LINESTRING Z (50 200 3, 100 100 2)", "1|3|1"},
                     {"LINESTRING Z (150 200 3, 100 100 2)", "2|3|1"},
                     {"LINESTRING Z (100 100 2, 100 0 1)", "3|0|2"}}};
}

NetworkFile read_back(ForeignLayer const& layer) {
    ScratchFolder const folder;
    return io::read_network(written(folder, "r.gpkg", {layer}), io::ReadNetworkParams{});
}

std::string failure(std::string const& path, io::ReadNetworkParams const& params = {}) {
    return error_of([&] { io::read_network(path, params); });
}

std::string failure(ForeignLayer const& layer) {
    ScratchFolder const folder;
    return failure(written(folder, "r.gpkg", {layer}));
}

/// A GeoPackage whose page of features is overwritten.
std::string damaged(ScratchFolder const& folder, OGRwkbGeometryType type) {
    std::string const marker = "a feature of the damaged page";
    std::string const path =
        written(folder, "damaged.gpkg",
                {{.type = type, .fields = "z_unit:s", .rows = {{"LINESTRING Z (0 0 3,9 9 1)", marker}}}});
    std::string bytes = bytes_of(path);
    constexpr std::size_t page = 4096;
    std::size_t const at = bytes.find(marker);
    EXPECT_NE(at, std::string::npos);
    bytes.replace(at / page * page, page, std::string(page, '\x5a'));
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
}

} // namespace

TEST(ReadNetwork, PathsThatAreNotNetworksAreRefused) {
    ScratchFolder const folder;
    folder.write("text.gpkg", "no network");
    folder.write("rivers.shp", "no network");
    for (std::string const& path :
         {folder / "none.gpkg", folder.path().string(), folder / "text.gpkg", folder / "rivers.shp"}) {
        EXPECT_TRUE(has(refusal(path), "BadInput io.read_network", path));
    }
}

TEST(ReadNetwork, EveryNameOfANetworkReadsTheSame) {
    ScratchFolder const folder;
    SampleNetwork const sample = two_basins();
    fs::create_directory(folder / "both");
    fs::create_directory(folder / "shapes");
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
        StreamNetwork const& plan = sample.network.planform;
        for (ArcId a = 0; a < plan.arc_count(); ++a) {
            NetworkFile::ArcColumns const& columns = file.arcs[a].columns;
            EXPECT_EQ(columns.n_up, static_cast<double>(plan.in(plan.from(a)).size()));
            EXPECT_EQ(columns.topo_ord, sample.orders.topological[a]);
            EXPECT_EQ(columns.hack, sample.orders.hack[a]);
            EXPECT_NEAR(columns.length_m, plan.length_m(a), 1e-9);
            EXPECT_GT(columns.length_3d_m, plan.length_m(a) - 1e-9);
            EXPECT_NEAR(columns.straight_m, plan.length_m(a), 1e-9);
            EXPECT_EQ(columns.z_up_m, file.arcs[a].line.front().z);
            EXPECT_EQ(columns.z_down_m, file.arcs[a].line.back().z);
            EXPECT_NEAR(columns.dist_out_m, sample.orders.node_dist_out_m[plan.to(a)], 1e-9);
            EXPECT_NEAR(columns.slope, (columns.z_up_m - columns.z_down_m) / columns.length_m, 1e-12);
        }
        for (NodeId n = 0; n < plan.node_count(); ++n) {
            NetworkFile::NodeColumns const& columns = file.nodes[n].columns;
            EXPECT_EQ(columns.kind, name_of(kind_of(plan, n)));
            EXPECT_EQ(columns.deg_in, static_cast<double>(plan.in(n).size()));
            EXPECT_EQ(columns.deg_out, plan.out(n) == no_arc ? 0.0 : 1.0);
            EXPECT_EQ(columns.basin_id, static_cast<double>(sample.orders.node_basin[n]));
            EXPECT_EQ(columns.strahler, sample.orders.node_strahler[n]);
            EXPECT_EQ(columns.z_m, file.nodes[n].at.z);
            EXPECT_NEAR(columns.dist_out_m, sample.orders.node_dist_out_m[n], 1e-9);
            EXPECT_NEAR(columns.area_m2, sample.node_area_m2[n], 1e-6);
        }
    }
    io::write_shapefiles(sample.tables(), folder / "shapes/second");
    EXPECT_TRUE(has(refusal(folder / "shapes"), "BadInput", "2 files"));
    fs::remove(folder / "shapes/net_nodes.shp");
    EXPECT_TRUE(has(refusal(folder / "shapes/net_arcs.shp"), "BadInput", "net_nodes.shp"));
}

TEST(ReadNetwork, BadNumbersInAFileAreReadAsTheyStand) {
    ScratchFolder const folder;
    NetworkFile const file = io::read_network(
        changed(folder, {"UPDATE arcs SET ds_arc = 99, strahler = -7", "UPDATE nodes SET node_id = 1"}));
    EXPECT_EQ(file.arcs[0].ds_arc, 99);
    EXPECT_EQ(file.arcs[0].strahler, -7);
    EXPECT_EQ(file.nodes[3].id, 1);
}

TEST(ReadNetwork, WhatIsNotNativeIsRefused) {
    using Layers = std::vector<ForeignLayer>;
    struct Case {
        std::string words;
        Layers layers;
        std::function<void(ForeignLayer& arcs)> spoil = [](ForeignLayer&) {};
    };
    for (auto const& [words, layers, spoil] : {
             Case{"no layer nodes", {one_arc()[1]}},
             Case{"no field ds_arc", one_arc(), [](ForeignLayer& arcs) { arcs.fields[3].first = "other"; }},
             Case{"feature 1 has no to_node", one_arc(), [](ForeignLayer& arcs) { arcs.rows[0].values[2] = ""; }},
             Case{"strahler 1.5", one_arc(),
                  [](ForeignLayer& arcs) {
                      arcs.fields[4].second = OFTReal;
                      arcs.rows[0].values[4] = "1.5";
                  }},
             Case{"arc_id holds text", one_arc(), [](ForeignLayer& arcs) { arcs.fields[0].second = OFTString; }},
             Case{"feature 1 has no heights (Z)", one_arc("LINESTRING (0 0, 1 1)", wkbLineString)},
             Case{"feature 1", one_arc("POLYGON Z ((0 0 0, 1 1 0, 1 0 0, 0 0 0))", wkbPolygon25D)},
             Case{"feature 1 has 2 parts",
                  one_arc("MULTILINESTRING Z ((0 0 1, 1 1 0), (2 2 1, 3 3 0))", wkbMultiLineString25D)},
         }) {
        Layers changed_layers = layers;
        spoil(changed_layers.back());
        ScratchFolder const folder;
        EXPECT_TRUE(has(refusal(written(folder, "a.gpkg", changed_layers)), "BadInput io.read_network", words));
    }
}

TEST(ReadNetwork, WholeNumbersMayBeRealAndOnePartIsALine) {
    ScratchFolder const folder;
    auto whole = one_arc();
    whole[1].fields[4].second = OFTReal;
    whole[1].rows[0].values[4] = "3.0";
    EXPECT_EQ(io::read_network(written(folder, "whole.gpkg", whole)).arcs[0].strahler, 3);
    auto const part =
        written(folder, "part.gpkg", one_arc("MULTILINESTRING Z ((0 0 1, 1 1 0))", wkbMultiLineString25D));
    EXPECT_EQ(io::read_network(part).arcs[0].line, (std::vector<Vec3>{{0, 0, 1}, {1, 1, 0}}));
    EXPECT_TRUE(io::read_network(written(folder, "empty.gpkg", one_arc("LINESTRING Z EMPTY"))).arcs[0].line.empty());
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
    std::string const bytes = bytes_of(path);
    int refused = 0;
    for (std::size_t const tenths : {2, 3, 4, 5, 6}) {
        std::string damaged_bytes = bytes;
        damaged_bytes.replace(tenths * bytes.size() / 10 / 4096 * 4096, 3 * 4096, std::string(3 * 4096, '\x55'));
        folder.write("damaged.gpkg", damaged_bytes);
        try {
            NetworkFile const read = io::read_network(folder / "damaged.gpkg");
            EXPECT_EQ(read.arcs.size(), 2999U);
            EXPECT_EQ(read.nodes.size(), 3000U);
        } catch (Error const&) {
            ++refused;
        }
    }
    EXPECT_GE(refused, 2);
    folder.write("cut.gpkg", bytes.substr(0, bytes.size() / 2));
    EXPECT_THROW(io::read_network(folder / "cut.gpkg"), Error);
}

TEST(BadNetwork, CleanFileHasNoFindings) {
    NetworkFile const file = read_back(rivers());
    EXPECT_TRUE(file.findings.empty()) << file.findings.front().text;
    EXPECT_TRUE(file.says.heights);
    EXPECT_EQ(file.nodes[1].at, (Vec3{100, 100, 2}));
}

TEST(BadNetwork, PartsThatJoinAreOneLineWhateverTheirOrder) {
    ForeignLayer layer = rivers();
    layer.rows[1].wkt =
        "MULTILINESTRING Z ((130 150 2.5, 110 120 2.2),(110 120 2.2, 100 100 2),(150 200 3, 130 150 2.5))";
    NetworkFile const file = read_back(layer);
    ASSERT_EQ(file.arcs.size(), 3U);
    EXPECT_EQ(file.arcs[1].line, (std::vector<Vec3>{{150, 200, 3}, {130, 150, 2.5}, {110, 120, 2.2}, {100, 100, 2}}));
    Finding const finding = finding_of(file, "multi_part");
    EXPECT_EQ(finding.feature, 2);
    EXPECT_EQ(finding.amount, 3.0);
    EXPECT_EQ(finding.where, (Vec2{150, 200}));
    EXPECT_EQ(file.findings.size(), 1U);
}

TEST(BadNetwork, PartsThatDoNotJoinAreArcsOfOneId) {
    for (char const* const wkt :
         {"MULTILINESTRING Z ((150 200 3, 130 150 2.5),(110 120 2.2, 100 100 2))",
          "MULTILINESTRING Z ((150 200 3, 130 150 2.5),(130 150 2.5, 100 100 2),(130 150 2.5, 0 0 0))",
          "MULTILINESTRING Z ((150 200 3, 130 150 2.5),(150 200 3, 130 150 2.5))",
          "MULTILINESTRING Z ((150 200 3, 130 150 2.5),(130 150 2.5, 150 200 3))"}) {
        ForeignLayer layer = rivers();
        layer.rows[1].wkt = wkt;
        NetworkFile const file = read_back(layer);
        EXPECT_GE(std::ranges::count(file.arcs, 2, &NetworkFile::FileArc::id), 2) << wkt;
        EXPECT_EQ(finding_of(file, "multi_part").feature, 2);
    }
}

TEST(BadNetwork, TypesOfCurvesAreLines) {
    std::string const straight = "(150 200 3, 120 150 2.5, 100 100 2)";
    std::string const arc = "CIRCULARSTRING Z (150 200 3, 140 130 2.5, 100 100 2)";
    for (std::string const& wkt :
         {"MULTICURVE Z (" + straight + ")", "COMPOUNDCURVE Z (" + straight + ")",
          "MULTICURVE Z (COMPOUNDCURVE Z (" + straight + "))", "GEOMETRYCOLLECTION Z (MULTICURVE Z (" + straight + "))",
          arc, "MULTICURVE Z (" + arc + ")", "COMPOUNDCURVE Z (" + arc + ")"}) {
        ForeignLayer layer = rivers();
        layer.rows[1].wkt = wkt;
        NetworkFile const file = read_back(layer);
        ASSERT_EQ(file.arcs.size(), 3U) << wkt;
        auto const& line = file.arcs[1].line;
        EXPECT_EQ(line.front(), (Vec3{150, 200, 3})) << wkt;
        EXPECT_EQ(line.back(), (Vec3{100, 100, 2})) << wkt;
        bool const is_curve = wkt.find("CIRCULAR") != std::string::npos;
        EXPECT_TRUE(is_curve ? line.size() > 10U : line[1] == (Vec3{120, 150, 2.5})) << wkt;
        EXPECT_EQ(finding_of(file, "curve").amount, is_curve ? static_cast<double>(line.size()) : 0.0) << wkt;
        EXPECT_EQ(finding_of(file, "curve").feature, is_curve ? 2 : 0) << wkt;
        EXPECT_EQ(count_of(file, "not_a_line"), 0) << wkt;
    }
}

TEST(BadNetwork, MeasuresAndMissingHeights) {
    ForeignLayer layer = rivers();
    layer.rows[0].wkt = "LINESTRING ZM (50 200 3 7, 100 100 2 8)";
    layer.rows[1].wkt = "LINESTRING M (150 200 7, 100 100 8)";
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
    layer.rows[0].wkt = "LINESTRING (50 200, 100 100)";
    layer.rows[1].wkt = "LINESTRING (150 200, 100 100)";
    layer.rows[2].wkt = "LINESTRING (100 100, 100 0)";
    NetworkFile const file = read_back(layer);
    EXPECT_FALSE(file.says.heights);
    EXPECT_EQ(finding_of(file, "no_heights").amount, 3.0);
    EXPECT_EQ(file.nodes.size(), 4U);
}

TEST(BadNetwork, NumbersAsTextAreNumbers) {
    ForeignLayer layer = rivers();
    layer.fields[0].second = OFTString;
    layer.fields[2].second = OFTString;
    layer.rows[2].values[0] = " 3 ";
    layer.rows[1].values[2] = "one";
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
    layer.rows[0].values[0] = "";
    layer.rows[1].values[2] = "";
    layer.rows[2].values[1] = "";
    NetworkFile const file = read_back(layer);
    EXPECT_EQ(file.arcs[0].id, 0);
    EXPECT_EQ(file.arcs[1].strahler, 0);
    EXPECT_EQ(file.arcs[2].ds_arc, 0);
    ASSERT_EQ(count_of(file, "null_number"), 2); // no arc downstream may be null
    EXPECT_TRUE(has(file.findings[0].text, "feature 1 has no HYRIV_ID"));
    EXPECT_EQ(file.findings[1].feature, 2);
}

TEST(BadNetwork, AThousandFindingsOfAKindAreEnough) {
    for (int const rows : {1000, 1500}) {
        ForeignLayer layer = rivers();
        layer.rows.clear();
        for (int i = 1; i <= rows; ++i) {
            std::string const x = std::to_string(i);
            layer.rows.push_back({"LINESTRING Z (" + x + " 10 2, " + x + " 0 1)", x + "|0|"});
        }
        NetworkFile const file = read_back(layer);
        EXPECT_EQ(file.findings.size(), rows == 1000 ? 1000U : 1001U); // one more counts the rest
        EXPECT_TRUE(rows == 1000 || file.findings.back().amount == 500.0);
    }
}

TEST(BadNetwork, WhatIsNoLineIsPassedOver) {
    ForeignLayer layer = rivers();
    layer.rows.push_back({"POLYGON ((0 0, 1 0, 1 1, 0 0))", "4|0|1"});
    layer.rows.push_back({"", "5|0|1"});
    layer.rows.push_back({"LINESTRING Z EMPTY", "6|0|1"});
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
    std::string const path = written(folder, "r.gpkg", {layer});
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
    layer.rows.push_back({"GEOMETRYCOLLECTION (POINT (0 0), LINESTRING (7 7, 8 8), POINT (1 1))", "4|0|1"});
    layer.rows.push_back({"GEOMETRYCOLLECTION (POINT (0 0), POLYGON ((0 0, 1 0, 1 1, 0 0)))", "5|0|1"});
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

TEST(BadNetwork, WhatCannotBeReadIsRefused) {
    ForeignLayer dates = rivers();
    dates.fields[1].second = OFTDate;
    EXPECT_TRUE(has(failure(dates), "BadInput io.read_network", "NEXT_DOWN"));
    ForeignLayer degrees = rivers(); // metres that are called degrees
    degrees.epsg = 4326;
    EXPECT_TRUE(has(failure(degrees), "BadInput", "longitude"));
    degrees.rows[0].wkt = "LINESTRING Z (9.5 47.2 3, 9.55 47.1 2)";
    degrees.rows[1].wkt = "LINESTRING Z (9.6 1e300 3, 9.55 47.1 2)";
    degrees.rows[2].wkt = "LINESTRING Z (9.55 47.1 2, 9.55 47.0 1)";
    EXPECT_TRUE(has(failure(degrees), "BadInput", "longitude"));
}

TEST(BadNetwork, AVertexThatIsNowhereIsLeftForTheCheck) {
    ForeignLayer layer = rivers();
    layer.epsg = 4326;
    layer.rows[0].wkt = "LINESTRING Z (9.5 47.2 3, 9.55 47.1 2)";
    layer.rows[1].wkt = "LINESTRING Z (9.6 95 3, 9.55 47.1 2)";
    layer.rows[2].wkt = "LINESTRING Z (9.55 47.1 2, 9.55 47.0 1)";
    layer.rows.push_back({"LINESTRING Z (9.55 0 3, 9.55 -1 2)", "4|0|1"}); // so that the middle is on earth
    NetworkFile const file = read_back(layer);
    EXPECT_TRUE(std::isnan(file.arcs[1].line.front().x));
    EXPECT_FALSE(std::isnan(file.arcs[1].line.back().x));
}

TEST(BadNetwork, LayersInDifferentCrsAreRefused) {
    ForeignLayer arcs = one_arc("LINESTRING Z (0 1 1, 0 0 0)")[1];
    arcs.rows[0].values = {"1", "1", "2", "0", "1", "1", "1"};
    ForeignLayer nodes{.name = "nodes",
                       .type = wkbPoint25D,
                       .epsg = 32632,
                       .fields = "node_id",
                       .rows = {{"POINT Z (0 1 1)", "1"}, {"POINT Z (0 0 0)", "2"}}};
    ScratchFolder const folder;
    EXPECT_TRUE(has(failure(written(folder, "mixed.gpkg", {arcs, nodes})), "BadInput"));
    nodes.epsg = 32631;
    NetworkFile const file = io::read_network(written(folder, "n.gpkg", {arcs, nodes}), io::ReadNetworkParams{});
    EXPECT_TRUE(file.says.nodes && file.findings.empty());
    // Without nodes, or without the orders, a network in the native schema is still one.
    arcs.fields.resize(4);
    arcs.rows[0].values.resize(4);
    NetworkFile const bare = io::read_network(written(folder, "b.gpkg", {arcs}), io::ReadNetworkParams{});
    EXPECT_EQ(count_of(bare, "missing_nodes"), 1);
    EXPECT_EQ(finding_of(bare, "missing_field").amount, 3.0);
    EXPECT_TRUE(has(finding_of(bare, "missing_field").text, "strahler, shreve, basin_id"));
    EXPECT_FALSE(bare.says.nodes || bare.says.strahler || bare.says.shreve || bare.says.basin);
    EXPECT_EQ(bare.nodes.size(), 2U);
    EXPECT_EQ(bare.nodes[0].at, (Vec3{0, 1, 1}));
}

TEST(BadNetwork, ShapefileInPieces) {
    ForeignLayer layer = rivers();
    layer.type = wkbLineString25D;
    for (std::string const ending : {".shx", ".dbf", ".shp"}) {
        ScratchFolder const folder;
        std::string const path = written(folder, "r.shp", {layer});
        fs::remove(folder / ("r" + ending));
        auto const before = state_of(folder);
        EXPECT_TRUE(has(failure(path), "r.shp")) << ending;
        EXPECT_EQ(state_of(folder), before) << ending;
        written(folder, "r.shp", {layer});
        for (std::uintmax_t const bytes : {fs::file_size(folder / ("r" + ending)) - 20, std::uintmax_t{50}}) {
            fs::resize_file(folder / ("r" + ending), bytes);
            auto const cut = state_of(folder);
            EXPECT_FALSE(failure(path).empty()) << ending << " of " << bytes << " bytes";
            EXPECT_EQ(state_of(folder), cut) << ending;
        }
    }
    for (std::size_t at = 0; at < 124; at += 3) { // a byte of the .shx gone wrong: an error, or the network
        ScratchFolder const folder;
        std::string const path = written(folder, "r.shp", {layer});
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
    for (std::string const name : {"r.gpkg", "r.shp", "r.fgb", "r.geojson"}) {
        ScratchFolder const folder;
        ForeignLayer layer = rivers();
        layer.type = wkbLineString25D;
        std::string const path = written(folder, name, {layer});
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
    std::string const path = written(folder, "r.gpkg", {rivers()});
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
    std::string const path = written(folder, "r.gpkg", {rivers()});
    std::ofstream(path + "-wal") << "of a copy that was open elsewhere"; // SQLite would delete it
    auto const before = state_of(folder);
    EXPECT_EQ(io::read_network(path, io::ReadNetworkParams{}).arcs.size(), 3U);
    EXPECT_EQ(state_of(folder), before);
}

TEST(BadNetwork, ALockedGeoPackageIsAnError) {
    ScratchFolder const folder;
    std::string const path = written(folder, "r.gpkg", {rivers()});
    auto writer = opened_to_change(path);
    execute(*writer, "BEGIN EXCLUSIVE");
    EXPECT_THROW(io::read_network(path, io::ReadNetworkParams{}), IoError);
    writer.reset();
    EXPECT_EQ(io::read_network(path, io::ReadNetworkParams{}).arcs.size(), 3U);
}

TEST(BadNetwork, DamagedFilesAreErrorsNotCrashes) {
    for (std::string const name : {"r.gpkg", "r.fgb", "r.geojson", "r.shp"}) {
        ScratchFolder const folder;
        ForeignLayer layer = rivers();
        layer.type = wkbLineString25D;
        std::string const path = written(folder, name, {layer});
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
    for (std::string const name :
         {"PG:host=127.0.0.1 port=1 dbname=rivers user=x password=geheim",
          "PG:host=127.0.0.1 port=1 password='ge heim' dbname=rivers", "postgresql://x:geheim@127.0.0.1:1/rivers"}) {
        std::string const words = failure(name);
        EXPECT_TRUE(has(words, "rivers"));
        EXPECT_FALSE(has(words, "heim"));
    }
}

TEST(DamagedLayers, AreNotTakenForEmptyOnes) {
    ScratchFolder const folder;
    std::string const path = damaged(folder, wkbUnknown);
    EXPECT_THROW(content_of(path), IoError);
    EXPECT_THROW(find_rivers(path), IoError);
    auto const data = opened(path);
    ASSERT_NE(data, nullptr);
    EXPECT_THROW(require_lines(*data, {"io.test", "damaged.gpkg"}), IoError);
    EXPECT_THROW(rivers_layers(*data, "", {"io.test", "damaged.gpkg"}), IoError);
}

TEST(DamagedLayers, HeightsAreNotTakenForMetres) {
    ScratchFolder const folder;
    auto const data = opened(damaged(folder, wkbLineString25D));
    ASSERT_NE(data, nullptr);
    EXPECT_THROW(height_unit_of(*data->GetLayer(0)), IoError);
}

} // namespace read_network_test
