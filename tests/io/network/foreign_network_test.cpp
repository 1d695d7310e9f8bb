// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/read_network.hpp>

#include <array>
#include <cmath>
#include <set>

#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/network/write_network.hpp>

#include "sample_networks.hpp"
#include "vector_files.hpp"

namespace foreign_network_test {

using namespace thalweg;

// Names and values of the files as their publishers write them, not taken from the table under test.

namespace {

using test::error_of;
using test::has;

// Two sources, at (50, 200) and (150, 200), meet at (100, 100); the outlet is at (100, 0).
ForeignLayer taudem() {
    return {.name = "net",
            .type = wkbMultiLineString,
            .fields =
                "LINKNO DSLINKNO USLINKNO1 USLINKNO2 DSNODEID strmOrder Length:r Magnitude DSContArea:r strmDrop:r "
                "Slope:r StraightL:r USContArea:r WSNO DOUTEND:r DOUTSTART:r DOUTMID:r",
            .rows = {{"MULTILINESTRING ((100 0, 100 50), (100 50, 100 100))",
                      "0|-1|1|2|-1|2|100|2|9000|1|.01|100|7000|0|0|100|50"},
                     {"MULTILINESTRING ((100 100, 50 200))",
                      "1|0|-1|-1|-1|1|111.8|1|4000|2|.02|111.8|100|1|100|211.8|155.9"},
                     {"MULTILINESTRING ((100 100, 120 150), (120 150, 150 200))",
                      "2|0|-1|-1|-1|1|112.2|1|3000|2|.02|111.8|200|2|100|212.2|156.1"}}};
}

ForeignLayer hydrorivers() {
    return {.name = "HydroRIVERS_v10_eu",
            .fields = "HYRIV_ID NEXT_DOWN MAIN_RIV LENGTH_KM:r DIST_DN_KM:r DIST_UP_KM:r CATCH_SKM:r UPLAND_SKM:r "
                      "ENDORHEIC DIS_AV_CMS:r ORD_STRA ORD_CLAS ORD_FLOW HYBAS_L12:l",
            .rows = {{"LINESTRING (50 200, 100 100)",
                      "20000001|20000003|20000003|0.11|0.1|0.11|1.5|1.5|0|0.1|1|2|8|2120000001"},
                     {"LINESTRING (150 200, 100 100)",
                      "20000002|20000003|20000003|0.11|0.1|0.11|2.5|2.5|0|0.1|1|1|8|2120000001"},
                     {"LINESTRING (100 100, 100 0)", "20000003|0|20000003|0.1|0|0.21|1|5|0|0.1|2|1|8|2120000001"}}};
}

// NHDPlus HR: its ids have 14 digits and are doubles.
ForeignLayer nhdplus_hr() {
    return {.name = "NHDFlowline",
            .type = wkbMultiLineStringZM,
            .fields = "NHDPlusID:r LengthKM:r StreamOrde FromNode:r ToNode:r HydroSeq:r DnHydroSeq:r TerminalPa:r "
                      "AreaSqKm:r TotDASqKm:r MaxElevSmo:r MinElevSmo:r",
            .rows = {{"MULTILINESTRING ZM ((50 200 0 0, 100 100 0 100))",
                      "55000800000011|0.1118|1|7001|7003|55000500000012|55000500000010|55000500000010|0.25|0.25|-9998|"
                      "-9998"},
                     {"MULTILINESTRING ZM ((150 200 0 0, 100 100 0 100))",
                      "55000800000012|0.1118|1|7002|7003|55000500000011|55000500000010|55000500000010|0.5|0.5|900|400"},
                     {"MULTILINESTRING ZM ((100 100 0 0, 100 0 0 100))",
                      "55000800000013|0.1|2|7003|7004|55000500000010|0|55000500000010|0.125|0.875|400|100"}}};
}

ForeignLayer grass_order() {
    return {.name = "streams_o",
            .fields = "cat stream next_stream prev_str01 prev_str02 strahler horton shreve hack topo_dim length:r "
                      "stright:r source_elev:r outlet_elev:r",
            .rows = {{"LINESTRING (50 200, 100 100)", "2|2|6|0|0|1|1|1|2|2|111.8|111.8|9|4"},
                     {"LINESTRING (150 200, 100 100)", "4|4|6|0|0|1|2|1|1|2|111.8|111.8|8|4"},
                     {"LINESTRING (100 100, 100 0)", "6|6|-1|2|4|2|2|2|1|1|100|100|4|1"}}};
}

NetworkFile read(ForeignLayer const& layer, io::ReadNetworkParams const& params = {},
                 std::string const& ending = ".gpkg") {
    ScratchFolder const folder;
    return io::read_network(written(folder, "net" + ending, {layer}), params);
}

using Flow = std::set<std::pair<std::int64_t, std::int64_t>>;

Flow flow_of(NetworkFile const& file) {
    Flow flow;
    for (auto const& arc : file.arcs) {
        flow.insert({arc.id, arc.ds_arc});
    }
    return flow;
}

// Arcs join at nodes that lie where the arcs end, and follow one another.
testing::AssertionResult hangs_together(NetworkFile const& file) {
    for (auto const& arc : file.arcs) {
        auto const at = [&](std::int64_t id) {
            auto const node = std::ranges::find(file.nodes, id, &NetworkFile::FileNode::id);
            return node == file.nodes.end() ? Vec2{NAN, NAN} : Vec2{node->at.x, node->at.y};
        };
        if (at(arc.from_node) != Vec2{arc.line.front().x, arc.line.front().y} ||
            at(arc.to_node) != Vec2{arc.line.back().x, arc.line.back().y}) {
            return testing::AssertionFailure() << "arc " << arc.id << " does not end at its nodes";
        }
        auto const below = std::ranges::find(file.arcs, arc.ds_arc, &NetworkFile::FileArc::id);
        if (arc.ds_arc != 0 && (below == file.arcs.end() || below->from_node != arc.to_node)) {
            return testing::AssertionFailure() << "arc " << arc.id << " does not reach the one downstream";
        }
    }
    return testing::AssertionSuccess();
}

// The parts that the file itself says, in words.
std::string says_of(NetworkFile const& file) {
    std::string words;
    for (auto const& [says, word] :
         {std::pair(file.says.nodes, " nodes"), std::pair(file.says.ends, " ends"),
          std::pair(file.says.downstream, " downstream"), std::pair(file.says.strahler, " strahler"),
          std::pair(file.says.shreve, " shreve"), std::pair(file.says.basin, " basin"),
          std::pair(file.says.heights, " heights"), std::pair(file.says.areas, " areas")}) {
        words += says ? word : "";
    }
    return words;
}

std::string refusal(std::string const& path, io::ReadNetworkParams const& params = {}) {
    return error_of([&] { io::read_network(path, params); });
}

double length_m(NetworkFile::FileArc const& arc) {
    double length = 0.0;
    for (std::size_t i = 1; i < arc.line.size(); ++i) {
        length += distance({arc.line[i - 1].x, arc.line[i - 1].y}, {arc.line[i].x, arc.line[i].y});
    }
    return length;
}

} // namespace

TEST(ForeignNetwork, TauDemIsTurnedAndCountedFromOne) {
    NetworkFile const file = read(taudem(), {}, ".shp");
    EXPECT_EQ(file.schema, "taudem");
    EXPECT_EQ(file.crs, "EPSG:32631");
    EXPECT_EQ(file.id_shift, 1);
    EXPECT_EQ(flow_of(file), (Flow{{1, 0}, {2, 1}, {3, 1}}));
    EXPECT_EQ(file.arcs[0].feature, 1);
    EXPECT_EQ(file.arcs[2].feature, 3);
    ASSERT_EQ(file.arcs[2].line.size(), 3U);
    EXPECT_EQ(file.arcs[2].line[0].x, 150.0);
    EXPECT_EQ(file.arcs[2].line[2].y, 100.0);
    EXPECT_EQ(file.arcs[0].line.back().y, 0.0);
    EXPECT_TRUE(std::isnan(file.arcs[0].line[0].z));
    EXPECT_EQ(file.arcs[0].strahler, 2);
    EXPECT_EQ(file.arcs[0].shreve, 2);
    EXPECT_EQ(file.arcs[0].ds_area_m2, 9000.0);
    EXPECT_EQ(file.arcs[0].us_area_m2, 7000.0);
    EXPECT_EQ(file.nodes.size(), 4U);
    EXPECT_TRUE(hangs_together(file));
    EXPECT_EQ(says_of(file), " downstream strahler shreve areas");
    EXPECT_EQ(count_of(file, "multi_part") + count_of(file, "turned"), 0); // every segment is a part there
    ForeignLayer older = taudem();
    older.fields[5].first = "Order";
    older.fields[9].first = "Drop";
    EXPECT_EQ(read(older, {}, ".shp").arcs[0].strahler, 2);
}

TEST(ForeignNetwork, TauDemDrawnDownstreamIsKeptAndReported) {
    ForeignLayer layer = taudem();
    layer.rows[0].wkt = "MULTILINESTRING ((100 100, 100 0))";
    layer.rows[1].wkt = "MULTILINESTRING ((50 200, 100 100))";
    layer.rows[2].wkt = "MULTILINESTRING ((150 200, 100 100))";
    NetworkFile const file = read(layer);
    EXPECT_EQ(file.arcs[0].line.back().y, 0.0);
    EXPECT_EQ(finding_of(file, "turned").amount, 3.0);
    EXPECT_TRUE(hangs_together(file));
}

TEST(ForeignNetwork, OneLineDrawnTheOtherWayIsLeftForTheCheck) {
    ForeignLayer layer = taudem();
    for (int i = 0; i < 3; ++i) { // a longer stem, so that most lines are as they should be
        std::string const y = std::to_string(-100 * i);
        std::string const below = std::to_string(-100 * (i + 1));
        layer.rows.push_back({"MULTILINESTRING ((100 " + below + ", 100 " + y + "))",
                              std::to_string(3 + i) + "|" + (i == 2 ? "-1" : std::to_string(4 + i)) + "|0|-1|-1|2"});
    }
    layer.rows[0].values[1] = "3";
    layer.rows[1].wkt = "MULTILINESTRING ((50 200, 100 100))";
    NetworkFile const file = read(layer);
    EXPECT_EQ(file.arcs[1].line.front().y, 100.0);
    EXPECT_EQ(file.arcs[1].ds_arc, 1);
    EXPECT_EQ(file.arcs[2].line.front().y, 200.0);
    EXPECT_EQ(count_of(file, "turned"), 0);
}

TEST(ForeignNetwork, NhdPlusIsLinkedByHydroseq) {
    NetworkFile const file = read(nhdplus_hr());
    EXPECT_EQ(file.schema, "nhdplus");
    EXPECT_EQ(flow_of(file),
              (Flow{{55000800000011, 55000800000013}, {55000800000012, 55000800000013}, {55000800000013, 0}}));
    EXPECT_EQ(file.arcs[0].from_node, 7001);
    EXPECT_EQ(file.arcs[0].to_node, 7003);
    EXPECT_EQ(file.nodes.size(), 4U);
    EXPECT_EQ(file.nodes[2].id, 7003);
    EXPECT_EQ(file.nodes[2].at.x, 100.0);
    EXPECT_TRUE(hangs_together(file));
    EXPECT_EQ(file.arcs[2].ds_area_m2, 875000.0);
    EXPECT_EQ(file.arcs[2].us_area_m2, 750000.0);
    EXPECT_EQ(file.arcs[2].basin, 55000500000010);
    EXPECT_EQ(file.arcs[2].feature, 3);
    EXPECT_EQ(std::get<double>(file.attributes.rows[2][0]), 55000800000013.0);
    EXPECT_EQ(says_of(file), " ends downstream strahler basin areas"); // a Z that is 0 everywhere is no height
    EXPECT_EQ(finding_of(file, "measures").amount, 3.0);
}

TEST(ForeignNetwork, WalkerCreekIsATree) {
    NetworkFile const file =
        io::read_network(THALWEG_SOURCE_DIR "/samples/walker_nhdplus.gpkg", io::ReadNetworkParams{});
    EXPECT_EQ(file.schema, "nhdplus");
    EXPECT_EQ(file.crs, "EPSG:32610");
    EXPECT_EQ(file.arcs.size(), 62U);
    EXPECT_EQ(file.nodes.size(), 63U);
    EXPECT_TRUE(hangs_together(file));
    EXPECT_EQ(std::ranges::count(file.arcs, 0, &NetworkFile::FileArc::ds_arc), 1);
    EXPECT_EQ(file.arcs[0].id, 5329303);
    EXPECT_EQ(file.arcs[0].ds_arc, 0);
    EXPECT_EQ(file.arcs[0].strahler, 4);
    EXPECT_NEAR(file.arcs[0].ds_area_m2, 193.9473e6, 1.0);
    EXPECT_NEAR(length_m(file.arcs[0]), 1195.0, 40.0); // LENGTHKM; the sample has 3 vertices of the line
    Finding const cut = finding_of(file, "cut_below");
    EXPECT_EQ(cut.feature, 5329303);
    EXPECT_EQ(cut.amount, 10001330.0);
    EXPECT_EQ(cut.where.x, file.arcs[0].line.front().x);
    EXPECT_EQ(count_of(file, "reprojected"), 1);
}

TEST(ForeignNetwork, HydroRiversIsReprojectedToItsZone) {
    struct Case {
        int epsg;
        std::array<char const*, 3> wkt;
        double length_m; ///< of the lowest arc on the ground
    };
    // A tenth of a degree of the meridian there is 11.119 km; a metre of Web Mercator 0.680 m.
    for (Case const& c :
         {Case{4326,
               {"LINESTRING (9.50 47.20, 9.55 47.10)", "LINESTRING (9.60 47.20, 9.55 47.10)",
                "LINESTRING (9.55 47.10, 9.55 47.00)"},
               11119.0},
          Case{3857,
               {"LINESTRING (1057535 5975000, 1063101 5960000)", "LINESTRING (1068667 5975000, 1063101 5960000)",
                "LINESTRING (1063101 5960000, 1063101 5943639)"},
               0.680 * 16361.0}}) {
        ForeignLayer layer = hydrorivers();
        layer.epsg = c.epsg;
        for (std::size_t i = 0; i < 3; ++i) {
            layer.rows[i].wkt = c.wkt[i];
        }
        NetworkFile const file = read(layer, {}, ".shp");
        EXPECT_EQ(file.schema, "hydrorivers");
        EXPECT_EQ(file.crs, "EPSG:32632");
        EXPECT_EQ(count_of(file, "reprojected"), 1);
        EXPECT_EQ(flow_of(file), (Flow{{20000001, 20000003}, {20000002, 20000003}, {20000003, 0}}));
        EXPECT_TRUE(hangs_together(file));
        EXPECT_EQ(file.nodes.size(), 4U);
        EXPECT_NEAR(length_m(file.arcs[2]), c.length_m, 11.0);
        EXPECT_EQ(file.arcs[2].ds_area_m2, 5e6);
        EXPECT_EQ(file.arcs[2].us_area_m2, 4e6);
        EXPECT_EQ(file.arcs[1].strahler, 1);
        EXPECT_EQ(file.arcs[1].basin, 20000003);
        EXPECT_TRUE(file.says.basin);
        EXPECT_EQ(read(layer, {.crs = "EPSG:3857"}).crs, "EPSG:3857");
    }
}

TEST(ForeignNetwork, AnExtractEndsAtOutlets) {
    ForeignLayer layer = hydrorivers();
    layer.rows.pop_back();
    NetworkFile const file = read(layer, {}, ".fgb");
    EXPECT_EQ(flow_of(file), (Flow{{20000001, 0}, {20000002, 0}}));
    EXPECT_EQ(count_of(file, "cut_below"), 2);
    EXPECT_EQ(finding_of(file, "cut_below").amount, 20000003.0);
    EXPECT_FALSE(file.says.basin); // both name a river that is not there
}

TEST(ForeignNetwork, GrassStreamOrder) {
    for (std::string const ending : {".gpkg", ".shp"}) {
        ForeignLayer layer = grass_order();
        if (ending == ".shp") { // as they are shortened there
            layer.fields[2].first = "next_strea";
            layer.fields[12].first = "source_ele";
            layer.fields[13].first = "outlet_ele";
        }
        NetworkFile const file = read(layer, {}, ending);
        EXPECT_EQ(file.schema, "grass") << ending;
        EXPECT_EQ(flow_of(file), (Flow{{2, 6}, {4, 6}, {6, 0}})) << ending;
        EXPECT_EQ(file.arcs[2].strahler, 2);
        EXPECT_EQ(file.arcs[2].shreve, 2);
        EXPECT_TRUE(hangs_together(file));
        EXPECT_EQ(says_of(file), " downstream strahler shreve");
    }
}

TEST(ForeignNetwork, GrassExtractIsLinkedByPlaces) {
    NetworkFile const file = read({.type = wkbUnknown,
                                   .fields = "cat stream_type:s type_code network",
                                   .rows = {{"POINT (50 200)", "1|start|0|1"},
                                            {"LINESTRING (50 200, 100 100)", "1|start|0|1"},
                                            {"POINT (150 200)", "2|start|0|1"},
                                            {"LINESTRING (150 200, 100 100)", "2|start|0|1"},
                                            {"LINESTRING (100 100, 100 0)", "3|intermediate|1|1"}}});
    EXPECT_EQ(file.schema, "grass");
    EXPECT_EQ(says_of(file), " basin");
    EXPECT_EQ(flow_of(file), (Flow{{1, 3}, {2, 3}, {3, 0}}));
    Finding const points = finding_of(file, "not_a_line");
    EXPECT_EQ(points.amount, 2.0);
    EXPECT_TRUE(has(points.text, "feature 1"));
}

TEST(ForeignNetwork, LinksWithoutLengthAreBridged) {
    // TauDEM joins two streams at once: three of them by a link without length.
    ForeignLayer layer{.fields = "LINKNO DSLINKNO strmOrder",
                       .rows = {{"LINESTRING (0 0, 0 100)", "0|-1|2"},
                                {"LINESTRING (0 100, 0 100)", "1|0|2"},
                                {"LINESTRING (0 100, 50 200)", "2|0|1"},
                                {"LINESTRING (0 100, 0 100)", "3|1|1"},
                                {"LINESTRING (0 100, -50 200)", "4|3|1"}}};
    EXPECT_EQ(read(layer).arcs.size(), 5U);
    NetworkFile const file = read(layer, {.bridge = true});
    EXPECT_EQ(flow_of(file), (Flow{{1, 0}, {3, 1}, {5, 1}})); // ids from 1: none is 0
    EXPECT_EQ(count_of(file, "bridged"), 2);
    EXPECT_EQ(finding_of(file, "bridged").feature, 1); // by the ids of the file
    EXPECT_EQ(finding_of(file, "bridged").amount, 0.0);
    EXPECT_FALSE(file.says.strahler);
    layer.rows[0].values[1] = "1"; // links without length in a circle
    layer.rows[1].values[1] = "3";
    EXPECT_EQ(flow_of(read(layer, {.bridge = true})), (Flow{{1, 0}, {3, 1}, {5, 0}}));
}

TEST(ForeignNetwork, FieldsThatAUserNamesAreEnough) {
    ForeignLayer const layer{.name = "gewaesser",
                             .fields = "Nummer nach ordnung",
                             .rows = {{"LINESTRING (50 200, 100 100)", "11|13|1"},
                                      {"LINESTRING (150 200, 100 100)", "12|13|1"},
                                      {"LINESTRING (100 100, 100 0)", "13||2"}}};
    ScratchFolder const folder;
    std::string const path = written(folder, "g.gpkg", {layer});
    NetworkFile const file =
        io::read_network(path, {.fields = {{"arc_id", "nummer"}, {"ds_arc", "nach"}, {"strahler", "ordnung"}}});
    EXPECT_EQ(file.schema, "mapped");
    EXPECT_EQ(flow_of(file), (Flow{{11, 13}, {12, 13}, {13, 0}}));
    EXPECT_EQ(file.arcs[2].strahler, 2);
    EXPECT_EQ(says_of(file), " downstream strahler");
    EXPECT_EQ(count_of(file, "null_number"), 0); // no arc downstream

    EXPECT_TRUE(has(refusal(path), "BadInput", "Nummer, nach, ordnung"));
    EXPECT_TRUE(has(refusal(path, {.fields = {{"arc_id", "nummer"}}}), "BadInput"));
    EXPECT_TRUE(has(refusal(path, {.fields = {{"arc_id", "numer"}, {"ds_arc", "nach"}}}), "BadInput", "'Nummer'"));
    EXPECT_TRUE(has(refusal(path, {.fields = {{"arcid", "nummer"}}}), "BadInput io.read_network", "'arc_id'"));
    EXPECT_TRUE(has(refusal(path, {.schema = io::Schema::hydrorivers}), "BadInput", "HYRIV_ID"));
}

TEST(ForeignNetwork, AFieldMayBeMappedWithinASchema) {
    ForeignLayer layer = hydrorivers();
    layer.fields[0].first = "REACH";
    EXPECT_THROW(read(layer), BadInput);
    NetworkFile const file = read(layer, {.schema = io::Schema::hydrorivers, .fields = {{"arc_id", "reach"}}});
    EXPECT_EQ(file.arcs[2].id, 20000003);
    EXPECT_EQ(file.arcs[2].ds_area_m2, 5e6); // in km² as in the schema
}

TEST(ForeignNetwork, TheFeatureIdMayBeTheArcId) {
    NetworkFile const file = read({.fields = "source target",
                                   .rows = {{"LINESTRING (50 200, 100 100)", "5|7"},
                                            {"LINESTRING (150 200, 100 100)", "6|7"},
                                            {"LINESTRING (100 100, 100 0)", "7|8"}}},
                                  {.fields = {{"arc_id", "fid"}, {"from_node", "source"}, {"to_node", "target"}}});
    EXPECT_EQ(flow_of(file), (Flow{{1, 3}, {2, 3}, {3, 0}}));
    EXPECT_TRUE(file.says.ends && !file.says.downstream);
    EXPECT_TRUE(hangs_together(file));
}

TEST(ForeignNetwork, AnyLinesAreTakenByTheirFeaturesOnRequest) {
    // Ways as in OpenStreetMap: no links; the first in two parts that do not meet.
    ForeignLayer const ways{.type = wkbUnknown,
                            .fields = "osm_id:s waterway:s name:s",
                            .rows = {{"MULTILINESTRING ((50 200, 100 100), (50 300, 60 300))", "70|river|Po"},
                                     {"POINT (1 2)", "71||"},
                                     {"LINESTRING (150 200, 100 100)", "72|canal|"},
                                     {"LINESTRING (100 100, 100 0)", "73|river|Po"}}};
    EXPECT_THROW(read(ways), BadInput);
    NetworkFile const file = read(ways, {.any_lines = true});
    EXPECT_EQ(file.schema, "lines");
    EXPECT_EQ(flow_of(file), (Flow{{1, 4}, {1, 0}, {3, 4}, {4, 0}})); // as they meet
    EXPECT_EQ(says_of(file), "");
    EXPECT_EQ(finding_of(file, "by_feature").amount, 4.0);
    EXPECT_EQ(file.arcs[2].record, 3);
    EXPECT_EQ(file.arcs[2].unnatural, "waterway canal");
    EXPECT_EQ(file.arcs[3].name, "Po");
    EXPECT_EQ(std::get<std::string>(file.attributes.rows[3][0]), "73");
    // Fields that a user names are never ignored, and known schemas are recognised.
    EXPECT_THROW(read(ways, {.fields = {{"ds_arc", "osm_id"}}, .any_lines = true}), BadInput);
    EXPECT_EQ(read(taudem(), {.any_lines = true}).schema, "taudem");
}

TEST(ForeignNetwork, AnyLinesHaveTheLinksOfTheirFields) {
    NetworkFile const file = read({.fields = "OBJECT_ID:s NEXTDOWNID:s STRAHLER", // EU-Hydro
                                   .rows = {{"LINESTRING (50 200, 100 100)", "RL1|RL3|1"},
                                            {"LINESTRING (100 100, 150 200)", "RL2|RL3|1"}, // drawn upstream
                                            {"LINESTRING (100 100, 100 0)", "RL3|RL9|2"}}},
                                  {.any_lines = true});
    EXPECT_EQ(flow_of(file), (Flow{{1, 3}, {2, 3}, {3, 0}}));
    EXPECT_TRUE(file.says.downstream);
    EXPECT_EQ(file.arcs[2].size, (std::vector<double>{2.0}));
}

TEST(ForeignNetwork, FieldsOfTwoSchemasAreAmbiguous) {
    ForeignLayer layer = hydrorivers();
    layer.fields.emplace_back("LINKNO", OFTInteger);
    layer.fields.emplace_back("DSLINKNO", OFTInteger);
    EXPECT_THROW(read(layer), BadInput);
    EXPECT_EQ(read(layer, {.schema = io::Schema::hydrorivers}).arcs.size(), 3U);
}

TEST(ForeignNetwork, TheLayerIsTheOneThatIsUnderstoodOrNamed) {
    ForeignLayer const roads{.name = "roads", .fields = "name:s", .rows = {{"LINESTRING (0 0, 1 1)", "A 3"}}};
    ScratchFolder const folder;
    std::string const path = written(folder, "both.gpkg", {roads, taudem()});
    EXPECT_EQ(io::read_network(path, io::ReadNetworkParams{}).arcs.size(), 3U);
    EXPECT_TRUE(has(refusal(path, {.arcs_layer = "roads"}), "BadInput"));
    EXPECT_TRUE(has(refusal(path, {.arcs_layer = "rivers"}), "BadInput", "roads, net"));
    EXPECT_TRUE(has(refusal(path, {.nodes_layer = "points"}), "BadInput", "points"));
    ForeignLayer second = taudem();
    second.name = "other";
    EXPECT_TRUE(has(refusal(written(folder, "two.gpkg", {taudem(), second})), "BadInput", "net, other"));
}

TEST(ForeignNetwork, NativeIsNativeInEveryFormat) {
    ScratchFolder const folder;
    io::write_geopackage(two_basins().tables(), folder / "n.gpkg");
    for (io::NetworkFormat const format : {io::NetworkFormat::flatgeobuf, io::NetworkFormat::geojson2008}) {
        std::string const name = format == io::NetworkFormat::geojson2008 ? "x.geojson" : "x.fgb";
        io::write_network(two_basins().tables(), folder / name, {.format = format});
    }
    NetworkFile const original = io::read_network(folder / "n.gpkg");
    for (std::string const name : {"n.gpkg", "x_arcs.fgb", "x_nodes.fgb", "x_arcs.geojson"}) {
        NetworkFile const file = io::read_network(folder / name, io::ReadNetworkParams{});
        EXPECT_EQ(file.schema, "native") << name;
        EXPECT_TRUE(file.findings.empty()) << name << ": " << file.findings.front().text;
        ASSERT_EQ(file.nodes.size(), 8U) << name;
        ASSERT_EQ(file.arcs.size(), 6U) << name;
        EXPECT_EQ(says_of(file), " nodes ends downstream strahler shreve basin heights areas");
        for (auto const& arc : file.arcs) {
            auto const same = std::ranges::find(original.arcs, arc.id, &NetworkFile::FileArc::id);
            ASSERT_NE(same, original.arcs.end());
            EXPECT_EQ(arc.line, same->line);
            EXPECT_EQ(arc.ds_arc, same->ds_arc);
            EXPECT_EQ(arc.ds_area_m2, same->ds_area_m2);
        }
    }
    auto const last = std::ranges::find(original.arcs, 6, &NetworkFile::FileArc::id);
    EXPECT_EQ(last->type, "Bärenbach");
    EXPECT_EQ(last->feature, 123456789012345);
    EXPECT_EQ(last->persistence, 20.5);
    EXPECT_TRUE(std::isinf(original.arcs[0].persistence));
    EXPECT_EQ(original.arcs[0].type, "");
    EXPECT_EQ(original.arcs[0].us_area_m2, 0.1);
}

} // namespace foreign_network_test
