// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/read_rivers.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <ogrsf_frmts.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/crs/crs.hpp>

#include "vector_files.hpp"

namespace read_rivers_test {

using namespace thalweg;
using test::has;

namespace {

class ReadRivers : public ::testing::Test {
protected:
    std::string path(std::string const& name) const { return folder_ / name; }
    std::string write(std::string const& name, std::vector<ForeignLayer> const& layers) const {
        return written(folder_, name, layers);
    }
    std::string write(std::string const& name, std::string const& wkt, int epsg = 32633) const {
        return write(name, {{.type = wkbUnknown, .epsg = epsg, .rows = {{wkt}}}});
    }
    /// The rivers of a layer with these fields; features have lines apart from each other.
    RiverLines with_fields(char const* fields, std::vector<std::string> const& values,
                           io::ReadRiversParams params = {}) const {
        ForeignLayer layer{.epsg = 32633, .fields = fields};
        for (std::string const& value : values) {
            std::string const y = std::to_string(10 * layer.rows.size());
            layer.rows.push_back({"LINESTRING (0 " + y + ", 5 " + y + ")", value});
        }
        params.path = write("fields.gpkg", {layer});
        return io::read_rivers(params);
    }
    static std::string refusal(io::ReadRiversParams const& params) {
        return test::error_of([&] { io::read_rivers(params); });
    }

private:
    ScratchFolder folder_;
};

std::vector<Vec2> in_plan(RiverLine const& line) {
    std::vector<Vec2> result;
    for (auto const& v : line.vertices) {
        result.push_back({v.x, v.y});
    }
    return result;
}

/// What a member of each line is.
template <class T> std::vector<T> all(RiverLines const& rivers, T RiverLine::*member) {
    std::vector<T> values;
    for (RiverLine const& line : rivers.lines) {
        values.push_back(line.*member);
    }
    return values;
}

ForeignLayer const two_rivers{
    .epsg = 32633,
    .rows = {{"LINESTRING(500000 5000000,500100 5000000.5)"}, {"LINESTRING(500100 5000000.5,500200 5000100)"}}};

ForeignLayer named(std::string const& name) {
    ForeignLayer layer = two_rivers;
    layer.name = name;
    return layer;
}

} // namespace

TEST_F(ReadRivers, RefusalsNameFileLayerAndFeature) {
    test::write(path("text.gpkg"), "this is no GeoPackage");
    ForeignLayer const wells{.name = "wells", .type = wkbPoint, .rows = {{"POINT(1 2)"}}};
    std::string const points = write("points.gpkg", {wells});
    std::string const only = write("only.gpkg", {{.type = wkbUnknown, .rows = {{"POINT(1 2)"}, {"POINT(1 3)"}}}});
    std::string const two = write("two.gpkg", {named("canals"), named("roads"), wells});
    std::string const wide =
        write("wide.gpkg", {{.epsg = 4326, .rows = {{"LINESTRING(0 0,1 1)"}, {"LINESTRING(0 2,0 95)"}}}});
    std::string const globe = write(
        "globe.gpkg",
        {{.epsg = 4326,
          .rows = {{"LINESTRING(-170 60,-169 61)"}, {"LINESTRING(-50 60,-51 61)"}, {"LINESTRING(70 60,71 61)"}}}});
    ForeignLayer bare = named("bare");
    bare.epsg = 0;
    std::string const without = write("bare.shp", {bare});
    std::string const none_left = write("nothing.gpkg", {{.rows = {{"LINESTRING EMPTY"}}}});
    test::write(
        path("crs.geojson"),
        R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::99999"}},)"
        R"("features":[{"type":"Feature","properties":{},"geometry":{"type":"LineString","coordinates":)"
        R"([[500000,5000000],[501000,5001000]]}}]})");
    std::string const typed =
        write("typed.gpkg", {{.fields = "kind:s hydroseq:r", .rows = {{"LINESTRING(0 0,1 1)", "c|1.5"}}}});
    for (auto const& [params, words] : std::vector<std::pair<io::ReadRiversParams, std::string>>{
             {{.path = path("none.gpkg")}, path("none.gpkg")},
             {{.path = ""}, "''"},
             {{.path = path("text.gpkg")}, "text.gpkg"},
             {{.path = write("empty.gpkg", std::vector{ForeignLayer{}})}, "layer rivers of empty.gpkg"},
             {{.path = points}, "points.gpkg has no layer with lines (wells)"},
             {{.path = points, .layer = "wells"}, "Point"},
             {{.path = only}, "(rivers)"},
             {{.path = only, .layer = "rivers"}, "layer rivers of only.gpkg"},
             {{.path = two}, "2 layers with lines (canals, roads)"},
             {{.path = write("more.gpkg", {named("rivers"), named("river_lines")})}, "2 layers with lines"},
             {{.path = two, .layer = "canls"}, "Did you mean 'canals'?"},
             {{.path = without}, "layer bare of bare.shp has no CRS"},
             {{.path = without, .source_crs = "EPSG:x"}, "'EPSG:x'"},
             {{.path = wide, .source_crs = "EPSG:x"}, "'EPSG:x'"},
             {{.path = wide, .crs = "EPSG:32631"}, "vertex 2 of feature 2 of wide.gpkg"},
             {{.path = wide, .crs = "EPSG:4326"}, "is geographic"},
             {{.path = wide, .crs = "nonsense"}, "nonsense"},
             {{.path = globe}, "over 240 degrees of longitude"},
             {{.path = none_left}, "feature 1"},
             {{.path = path("crs.geojson")}, "crs.geojson"},
             {{.path = typed, .from_field = "kind", .to_field = "knd"}, "Did you mean 'kind'?"},
             {{.path = typed, .where = "knd = 'c'"}, "network.lines.where"},
             {{.path = typed, .where = "kind = 'd'"}, "no feature meets network.lines.where"},
             {{.path = typed, .type_field = "kint"}, "no field 'kint'"},
             {{.path = typed, .rank_field = "order"}, "no field 'order'"},
             {{.path = typed, .rank_field = "kind"}, "field kind"},
             {{.path = typed, .lambda_field = "number"}, "no field 'number'"},
             {{.path = typed, .id_field = "kind", .down_field = "knd"}, "Did you mean 'kind'?"}}) {
        EXPECT_TRUE(has(refusal(params), "BadInput", words));
    }
    EXPECT_TRUE(has(refusal({.path = typed, .id_field = "kind"}), "BadParameter io.read_rivers"));
    EXPECT_TRUE(has(refusal({.path = typed, .to_field = "kind"}), "BadParameter io.read_rivers"));
}

TEST_F(ReadRivers, ShapesThatAreNotLinesAreCounted) {
    auto const file = write("a.gpkg", {{.type = wkbUnknown,
                                        .rows = {{"POINT(1 2)"},
                                                 {"POLYGON((0 0,1 0,1 1,0 0))"},
                                                 {"LINESTRING(0 0,1 1)"},
                                                 {"GEOMETRYCOLLECTION(POINT(3 3),LINESTRING(1 1,5 1))"},
                                                 {"GEOMETRYCOLLECTION(POINT(4 4))"},
                                                 {"LINESTRING(7 7,7 7)"}}}});
    auto const read = io::read_rivers({.path = file});
    ASSERT_EQ(read.lines.size(), 2U);
    EXPECT_EQ(read.lines[0].feature, 3);
    EXPECT_EQ(read.lines[1].feature, 4);
    EXPECT_EQ(read.attributes.rows.size(), 6U);
    ASSERT_EQ(read.lakes.size(), 1U);
    EXPECT_EQ(read.lakes[0].feature, 2);
    ASSERT_EQ(read.findings.size(), 2U);
    EXPECT_EQ(read.findings[0].kind, "not_a_line");
    EXPECT_EQ(read.findings[0].amount, 3.0);
    EXPECT_EQ(read.findings[0].where, (Vec2{1.0, 2.0}));
    EXPECT_EQ(read.findings[1].kind, "left_out");
    ForeignLayer const catchments{.type = wkbUnknown,
                                  .fields = "kind:s",
                                  .rows = {{"POLYGON((0 0,1 0,1 1,0 0))", {"catchment"}}, {"LINESTRING(0 0,1 1)"}}};
    auto const other = io::read_rivers({.path = write("b.gpkg", {catchments})});
    EXPECT_TRUE(other.lakes.empty());
    ASSERT_EQ(other.findings.size(), 1U);
    EXPECT_EQ(other.findings[0].text, "1 shape of type Polygon is not a line and is skipped; it is in feature 1");
}

TEST_F(ReadRivers, OfSeveralLayersTheNameTells) {
    std::vector<ForeignLayer> const layers{named("rivers"), named("canals"), {.name = "wells", .type = wkbPoint}};
    EXPECT_EQ(io::read_rivers({.path = write("a.gpkg", layers)}).lines.size(), 2U);
    EXPECT_EQ(io::read_rivers({.path = path("a.gpkg"), .layer = "canals"}).lines.size(), 2U);
    EXPECT_EQ(io::read_rivers({.path = write("b.gpkg", {named("rivers"), named("Streams_2020")})}).lines.size(), 2U);
    EXPECT_EQ(io::read_rivers({.path = write("c.gpkg", {named("lines"), layers[2]})}).lines.size(), 2U);
}

TEST_F(ReadRivers, AGeoPackageNamesNoCrsByNumbers) {
    ForeignLayer layer = two_rivers;
    layer.epsg = 0;
    auto const file = write("b.gpkg", {layer});
    for (char const* const id : {"0", "-1"}) { // undefined geographic and undefined Cartesian
        auto const data = opened_to_change(file);
        for (std::string const table : {"gpkg_contents", "gpkg_geometry_columns"}) {
            execute(*data, "UPDATE " + table + " SET srs_id = " + id);
        }
        data->FlushCache();
        EXPECT_TRUE(has(refusal({.path = file, .crs = "EPSG:32633", .source_crs = ""}), "BadInput io.read_rivers"));
    }
}

TEST_F(ReadRivers, FieldsOfLinksCanBeNamed) {
    std::vector<std::string> const values{"7|9", "9|0"};
    EXPECT_EQ(all(with_fields("nummer nach", values), &RiverLine::down), (std::vector<std::int64_t>{0, 0}));
    EXPECT_EQ(all(with_fields("nummer nach", values, {.id_field = "Nummer", .down_field = "nach"}), &RiverLine::down),
              (std::vector<std::int64_t>{2, 0}));
}

TEST_F(ReadRivers, LinksNameLinesOfTheFile) {
    struct Case {
        char const* fields;
        std::vector<std::string> values;
        std::vector<std::int64_t> down;
    };
    for (auto const& [fields, values, down] : {
             // Text ids as in EU-Hydro: one names itself, one an unknown id, one has none; of two with one id the first
             // counts.
             Case{"OBJECT_ID:s NEXTDOWNID:s", {"a|b", "b|c", "c|c", "d|z", "e|", "b|a", "|a"}, {2, 3, 0, 0, 0, 1, 0}},
             Case{"HYRIV_ID:l NEXT_DOWN:l", {"20000000001|20000000002", "20000000002|0"}, {2, 0}}, // beyond 32 bits
             // MERIT-Basins has the COMID of NHDPlus and a link of its own.
             Case{"COMID NextDownID uparea:r", {"27000001|0|500", "27000002|27000001|300"}, {0, 1}},
             // thalweg's own links come before those that a file kept from NHDPlus.
             Case{"hydroseq:l dnhydroseq:l arc_id ds_arc", {"9|8|1|0", "8|0|2|1"}, {0, 1}},
             Case{"arc_id", {"1", "2"}, {0, 0}}, // an id without a link
         }) {
        EXPECT_EQ(all(with_fields(fields, values), &RiverLine::down), down) << fields;
    }
}

TEST_F(ReadRivers, SizesComeInTheirOrderAndClassesAfterThem) {
    struct Case {
        char const* fields;
        std::vector<std::string> values;
        std::vector<std::vector<double>> size;
    };
    for (auto const& [fields, values, size] : {
             // Whatever the order of the columns: area, discharge, order, class, in any case of letters.
             Case{"ord_clas ORD_STRA Dis_Av_Cms:r UPLAND_SKM:r",
                  {"1|3|2.5|40", "4||-9999|nan", "0|2|0|7"},
                  {{40.0, 2.5, 3.0, 1.0}, {0.0, 0.0, 0.0, 0.25}, {7.0, 0.0, 2.0, 0.0}}},
             Case{"COMID NextDownID uparea:r", {"1|0|500"}, {{500.0}}},
             Case{"STRAHLER", {"5"}, {{5.0}}},
             Case{"STRAHLER:s", {"5"}, {{}}}, // a text is no size
             Case{"id remark:s", {"1|x"}, {{}}},
         }) {
        EXPECT_EQ(all(with_fields(fields, values), &RiverLine::size), size) << fields;
    }
}

TEST_F(ReadRivers, NhdPlusMarksItsMainAndMinorPaths) {
    EXPECT_EQ(all(with_fields("Divergence StreamCalc StreamOrde", {"0|3|3", "1|3|3", "2|0|3", "0|0|3", "0|0|0", "||"}),
                  &RiverLine::channel),
              (std::vector<Channel>{Channel::unknown, Channel::main, Channel::minor, Channel::minor, Channel::unknown,
                                    Channel::unknown}));
}

TEST_F(ReadRivers, NamesAreFoundUnderTheNamesOfTheirFields) {
    EXPECT_EQ(with_fields("GNIS_Name:s", {"Walker Creek"}).lines[0].name, "Walker Creek");
    EXPECT_EQ(with_fields("nameTxtInt:s", {"Po"}).lines[0].name, "Po");
    EXPECT_EQ(with_fields("riv_name:s name:s", {"second|first"}).lines[0].name, "first");
    EXPECT_EQ(with_fields("id", {"1"}).lines[0].name, "");
}

TEST_F(ReadRivers, LinesThatAreNotNaturalWatercoursesAreSetAside) {
    struct Case {
        char const* fields;
        std::vector<std::string> values;
        std::string channels;  ///< feature and reason of what carries water all the same
        std::string secondary; ///< of the others
    };
    for (auto const& [fields, values, channels, secondary] : {
             Case{"waterway:s tunnel:s man_made:s barrier:s",
                  {"river|||", "Stream|no||", "Canal|||", "stream|flooded||", "stream|culvert||", "||pipeline|", "|||",
                   "Ditch|||", "drain|||", "weir|||", "|||ditch"}, // the last a dry one
                  "3 waterway canal; 4 tunnel flooded; 6 man_made pipeline; 8 waterway ditch; 9 waterway drain; ",
                  "10 waterway weir; 11 barrier ditch; "},
             Case{"FTYPE:s FCODE",
                  {"StreamRiver|46006", "Coastline|56600", "428|", "|33600", "ArtificialPath|55800", "|56700",
                   "CanalDitch|", "|56600"},
                  "3 FTYPE 428; 4 FCODE 33600 CanalDitch; 7 FTYPE CanalDitch; ",
                  "2 FTYPE Coastline; 8 FCODE 56600 Coastline; "},
         }) {
        RiverLines const rivers = with_fields(fields, values, {.filter = io::LineFilter::natural});
        std::string found;
        for (RiverLine const& line : rivers.channels) {
            found += std::to_string(line.feature) + " " + line.artificial + "; ";
        }
        EXPECT_EQ(found, channels);
        found.clear();
        for (SecondaryLine const& line : rivers.secondary) {
            found += std::to_string(line.feature) + " " + line.reason + "; ";
        }
        EXPECT_EQ(found, secondary);
        EXPECT_EQ(rivers.lines.size() + rivers.channels.size() + rivers.secondary.size(), values.size());
    }
}

TEST_F(ReadRivers, DirectionColumns) {
    struct Case {
        char const* field;
        std::vector<std::string> values;
        std::vector<int> runs;
    };
    for (auto const& [field, values, runs] : {
             Case{"flowDirection:s", {"inDirection", "inOppositeDirection"}, {1, -1}},     // INSPIRE
             Case{"flow_direction:s", {"in direction", "in opposite direction"}, {1, -1}}, // OS
             Case{"flow:s", {"both directions", "in direction"}, {0, 1}},
             Case{"sens_de_l_ecoulement:s", {"Sens inverse", "Sens direct", "Double sens", "Inconnu"}, {-1, 1, 0, 0}},
             Case{"SensEcoulementTH:s", {"Dans direction tronçon", "Dans les deux directions"}, {1, 0}}, // BD TOPAGE
             Case{"FlowDir", {"1", "2", "4"}, {1, -1, 0}},                                               // Esri
             Case{"FLOWDIRECTION", {"1", "2", "-1", "0"}, {1, -1, 0, 0}},                                // NHN
             Case{"flow", {"1", "2"}, {0, 0}}, // a discharge, say
         }) {
        EXPECT_EQ(all(with_fields(field, values), &RiverLine::runs), runs) << field;
    }
}

TEST_F(ReadRivers, LakesAreThePolygonsThatSaySo) {
    std::string const square = "POLYGON((500000 5000000,500010 5000000,500010 5000010,500000 5000010,500000 5000000))";
    auto const layer = [&](char const* name, char const* fields, std::vector<std::string> const& values) {
        ForeignLayer made{.name = name, .type = wkbUnknown, .fields = fields};
        for (std::string const& value : values) {
            std::string moved = square; // no two at one place
            for (std::size_t at = moved.find("5000"); at != std::string::npos; at = moved.find("5000", at + 4)) {
                moved[at + 3] = static_cast<char>('0' + made.rows.size());
            }
            made.rows.push_back({moved, {value}});
        }
        return made;
    };
    ForeignLayer const rivers{.name = "rivers", .rows = {{"LINESTRING(0 0,1 1)"}}};
    auto const lakes = [&](ForeignLayer const& polygons) {
        std::string features;
        for (Polygon const& lake : io::read_rivers({.path = write("a.gpkg", {rivers, polygons})}).lakes) {
            features += std::to_string(lake.feature);
        }
        return features;
    };
    EXPECT_EQ(lakes(layer("NHDWaterbody", "FTYPE", {"390", "436", "378", "493"})), "12");
    EXPECT_EQ(lakes(layer("plan_d_eau", "nature:s", {"Lac", "Retenue"})), "12");
    EXPECT_EQ(lakes(layer("catchments", "id", {"1", "2"})), "");
    EXPECT_EQ(lakes(layer("multipolygons", "osm_id:s natural:s", {"1", "2"})), "") << "no natural = water";
    EXPECT_EQ(lakes(layer("multipolygons", "natural:s osm_id:s", {"water", "wood", "water"})), "13");
    for (char const* name : {"A05_Vodni_nadrze", "stehende_gewaesser", "jezera", "sjö", "Seen", "plan_d_eau"}) {
        EXPECT_EQ(lakes(layer(name, "id", {"1"})), "1") << name;
    }
    for (char const* name : {"lake_catchments", "lake_district", "lake_shore_buffer", "see_einzugsgebiete"}) {
        EXPECT_EQ(lakes(layer(name, "id", {"1"})), "") << name;
    }
    // Among the lines: what says that it is something else is no lake, what says nothing is one.
    auto const among = [&](std::string const& field, std::string const& value) {
        ForeignLayer both{.name = "a", .type = wkbUnknown, .fields = (field + ":s").c_str()};
        both.rows = {{"LINESTRING(0 0,1 1)", {""}}, {square, {value}}};
        return io::read_rivers({.path = write("m.gpkg", {both})}).lakes.size();
    };
    for (auto const& [field, value] :
         std::vector<std::pair<std::string, std::string>>{{"boundary", "administrative"},
                                                          {"natural", "wood"},
                                                          {"natural", "glacier"},
                                                          {"landuse", "forest"},
                                                          {"place", "island"},
                                                          {"building", "yes"},
                                                          {"leisure", "park"},
                                                          {"featuretype", "watershed"},
                                                          {"description", "drainage basin"},
                                                          {"admin_level", "2"},
                                                          {"ISO_A3", "CHE"},
                                                          {"HYBAS_ID", "2060000001"},
                                                          {"huc12", "010100020101"},
                                                          {"kind", "Einzugsgebiet"},
                                                          {"water", "river"},
                                                          {"waterway", "riverbank"}}) {
        EXPECT_EQ(among(field, value), 0U) << field << " = " << value;
        EXPECT_EQ(among(field, ""), 1U) << field;
    }
    EXPECT_EQ(among("natural", "water"), 1U);
    EXPECT_EQ(among("water", "pond"), 1U);
    EXPECT_EQ(among("name", "Lake District Pond"), 1U);
    // A polygon around the rivers is no lake.
    ForeignLayer around{.name = "a", .type = wkbUnknown, .fields = "name:s"};
    around.rows = {{"LINESTRING(0 0,1 1,2 1)", {"a"}}, {"POLYGON((-9 -9,9 -9,9 9,-9 9,-9 -9))", {"b"}}};
    RiverLines const in_it = io::read_rivers({.path = write("r.gpkg", {around})});
    EXPECT_TRUE(in_it.lakes.empty());
    ASSERT_EQ(in_it.findings.size(), 1U);
    EXPECT_TRUE(test::has(in_it.findings[0].text, "polygon 2 is no lake")) << in_it.findings[0].text;
    ForeignLayer mixed{.name = "a", .type = wkbUnknown, .fields = "name:s"};
    mixed.rows = {{"LINESTRING(0 0,1 1)", {"a"}}, {square, {"b"}}};
    RiverLines const read = io::read_rivers({.path = write("b.gpkg", {mixed})});
    ASSERT_EQ(read.lakes.size(), 1U);
    EXPECT_EQ(read.lakes[0].feature, 2);
    EXPECT_EQ(read.lakes[0].rings[0].size(), 4U);
    EXPECT_TRUE(read.findings.empty()) << "nothing is passed over";
}

TEST_F(ReadRivers, ACrsThatIsMissingCanBeNamed) {
    ForeignLayer layer = named("a");
    layer.epsg = 0;
    auto const bare = write("a.shp", {layer});
    auto const read = io::read_rivers({.path = bare, .source_crs = "EPSG:32633"});
    EXPECT_EQ(read.crs, "EPSG:32633");
    EXPECT_EQ(in_plan(read.lines[0]), (std::vector<Vec2>{{500000, 5000000}, {500100, 5000000.5}}));
    auto const moved = io::read_rivers({.path = bare, .crs = "EPSG:32632", .source_crs = "EPSG:32633"});
    EXPECT_EQ(moved.crs, "EPSG:32632");
    EXPECT_GT(moved.lines[0].vertices[0].x, 900000.0);
    auto const own = io::read_rivers({.path = write("b.gpkg", {two_rivers}), .source_crs = "EPSG:32632"});
    EXPECT_EQ(own.crs, "EPSG:32633");
    layer.rows = {{"LINESTRING Z(500000 5000000 100,500100 5000000 50)"}};
    layer.type = wkbLineString25D;
    auto const feet =
        io::read_rivers({.path = write("a.shp", {layer}), .source_crs = "EPSG:32633+6360"}); // NAVD88 in US feet
    EXPECT_NEAR(feet.lines[0].vertices[0].z, 100.0 * 1200.0 / 3937.0, 1e-9);
}

TEST_F(ReadRivers, FeaturesWithoutALineAreLeftOut) {
    auto const some = io::read_rivers({.path = write("a.gpkg", {{.rows = {{"LINESTRING(0 0,1 1)"},
                                                                          {""},
                                                                          {"LINESTRING EMPTY"},
                                                                          {"LINESTRING(5 5)"},
                                                                          {"LINESTRING(6 6,6 6)"},
                                                                          {"LINESTRING(2 2,3 3)"}}}})});
    ASSERT_EQ(some.lines.size(), 2U);
    EXPECT_EQ(some.lines[1].feature, 6);
    ASSERT_EQ(some.findings.size(), 4U);
    for (std::int64_t k = 0; k < 4; ++k) {
        EXPECT_EQ(some.findings[static_cast<std::size_t>(k)].kind, "left_out");
        EXPECT_EQ(some.findings[static_cast<std::size_t>(k)].feature, k + 2);
    }
    EXPECT_EQ(some.attributes.rows.size(), 6U);
}

TEST_F(ReadRivers, CoordinatesThatAreNotFinite) {
    for (double const bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        auto const file = write("a.shp", {two_rivers});
        auto shp = bytes_of(file);
        double const y = 5000100.0; // of the last vertex
        auto const place = shp.rfind(std::string(reinterpret_cast<char const*>(&y), sizeof y));
        ASSERT_NE(place, std::string::npos);
        shp.replace(place, sizeof bad, reinterpret_cast<char const*>(&bad), sizeof bad);
        std::ofstream(file, std::ios::binary) << shp;
        EXPECT_TRUE(has(refusal({.path = file}), "vertex 2 of feature 2 of a.shp is not finite"));
    }
}

TEST_F(ReadRivers, CorruptFile) {
    std::vector<ForeignLayer::Row> many;
    for (int i = 0; i < 3000; ++i) {
        many.push_back({"LINESTRING(0 0,1 1,2 " + std::to_string(i) + ",3 3,4 4,5 5,6 6)"});
    }
    auto const file = write("a.gpkg", {{.rows = many}});
    auto bytes = bytes_of(file);
    // Pages in the middle of the table, past the schema.
    std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() / 3),
              bytes.begin() + static_cast<std::ptrdiff_t>(2 * bytes.size() / 3), '\x5a');
    std::ofstream(file, std::ios::binary) << bytes;
    EXPECT_THROW(io::read_rivers({.path = file}), Error);
}

TEST_F(ReadRivers, StopsWhenAsked) {
    EXPECT_THROW(io::read_rivers({.path = write("a.gpkg", {two_rivers})}, test::stopped_run()), Cancelled);
}

TEST_F(ReadRivers, OwnProjectionIsKept) {
    auto const file = write("a.gpkg", {two_rivers});
    auto const before = bytes_of(file);
    auto const rivers = io::read_rivers({.path = file});
    EXPECT_EQ(bytes_of(file), before);
    EXPECT_EQ(rivers.crs, "EPSG:32633");
    EXPECT_EQ(rivers.name, "a.gpkg");
    EXPECT_FALSE(rivers.has_z);
    ASSERT_EQ(rivers.lines.size(), 2U);
    EXPECT_EQ(rivers.lines[0].feature, 1);
    EXPECT_EQ(rivers.lines[1].feature, 2);
    EXPECT_EQ(in_plan(rivers.lines[0]), (std::vector<Vec2>{{500000, 5000000}, {500100, 5000000.5}}));
    EXPECT_TRUE(std::isnan(rivers.lines[0].vertices[0].z));
}

TEST_F(ReadRivers, EveryFormatGivesTheSame) {
    for (std::string const name : {"a.gpkg", "a.shp", "a.fgb", "a.geojson"}) {
        auto const rivers = io::read_rivers({.path = write(name, {two_rivers})});
        EXPECT_EQ(rivers.crs, "EPSG:32633") << name;
        ASSERT_EQ(rivers.lines.size(), 2U) << name;
        auto plans = std::vector{in_plan(rivers.lines[0]), in_plan(rivers.lines[1])};
        std::ranges::sort(plans, {}, [](auto const& p) { return p.front().x; }); // FlatGeobuf orders by place
        EXPECT_EQ(plans[0], (std::vector<Vec2>{{500000, 5000000}, {500100, 5000000.5}})) << name;
        EXPECT_EQ(plans[1], (std::vector<Vec2>{{500100, 5000000.5}, {500200, 5000100}})) << name;
    }
}

TEST_F(ReadRivers, CoordinatesGoToMetresOnTheGround) {
    struct Case {
        int epsg;
        std::string wkt;
        std::string crs;
        double length_m; ///< between the first two vertices; 0: not compared
    };
    for (auto const& [epsg, wkt, crs, length_m] : {
             Case{4326, "LINESTRING(15 45,15 45.01)", "EPSG:32633", 1110.9}, // 1111.35 m, scaled by 0.9996
             Case{4326, "LINESTRING(15 -45,15 -45.01)", "EPSG:32733", 1110.9},
             // 12 degrees wide, and wider.
             Case{4326, "LINESTRING(4 45,16 45)", "EPSG:32632", 0.0},
             Case{4326, "LINESTRING(-10 48,40 48)", "Equal area around 15, 48", 0.0},
             Case{4326, "LINESTRING(-5 70,35 70)", "Equal area around 15, 70", 0.0},
             Case{4326, "LINESTRING(179.98 -16,-179.97 -16)", "EPSG:32701", 5350.0}, // across the antimeridian
             // At 47 degrees north, where a metre of Web Mercator is 0.68 m; feet of California.
             Case{3857, "LINESTRING(1001875.417 5934492.151,1001875.417 5949180.027)", "EPSG:32632", 10000.0},
             Case{2225, "LINESTRING(6561666 1640416,6561966 1640416)", "EPSG:32610", 300 * 0.3048},
         }) {
        auto const rivers = io::read_rivers({.path = write("a.gpkg", wkt, epsg)});
        EXPECT_TRUE(has(rivers.crs, crs)) << wkt;
        EXPECT_EQ(io::projected_crs(rivers.crs), rivers.crs);
        auto const line = in_plan(rivers.lines[0]);
        EXPECT_TRUE(length_m == 0.0 || std::fabs(distance(line[0], line[1]) / length_m - 1.0) < 0.004) << wkt;
    }
    auto const wide = write("a.gpkg", "LINESTRING(-10 48,40 48)", 4326);
    auto const line = in_plan(io::read_rivers({.path = wide}).lines[0]);
    EXPECT_NEAR(line.front().x, -line.back().x, 1e-5); // the middle is the origin
    EXPECT_EQ(io::read_rivers({.path = wide, .crs = "EPSG:3035"}).crs, "EPSG:3035");
    // On the central meridian of zone 33 x is 500 km; y of 45 degrees north times the scale 0.9996.
    auto const zone = io::read_rivers({.path = write("b.gpkg", "LINESTRING(15 45,15 45.01)", 4326)});
    EXPECT_EQ(zone.lines[0].vertices[0].x, 500000.0);
    EXPECT_NEAR(zone.lines[0].vertices[0].y, 4982950.4, 0.1);
    // A CRS that is asked for, though its metres are not metres on the ground; ETRS89 is the same to the millimetre.
    auto const kept =
        io::read_rivers({.path = write("c.gpkg", "LINESTRING(1 2,3 5949180.027)", 3857), .crs = "EPSG:3857"});
    EXPECT_EQ(kept.lines[0].vertices[1].y, 5949180.027);
    auto const etrs = io::read_rivers({.path = write("d.gpkg", {two_rivers}), .crs = "EPSG:25833"});
    EXPECT_EQ(etrs.crs, "EPSG:25833");
    EXPECT_NEAR(distance(in_plan(etrs.lines[0])[0], {500000.0, 5000000.0}), 0.0, 1e-3);
}

TEST_F(ReadRivers, CoordinatesAreRounded) {
    auto const file = write("a.gpkg", {{.rows = {{"LINESTRING(0.12345678 -0.0000004,1.0000005 1)"}}}});
    EXPECT_EQ(in_plan(io::read_rivers({.path = file}).lines[0]), (std::vector<Vec2>{{0.123457, 0.0}, {1.000001, 1.0}}));
}

TEST_F(ReadRivers, PartsAndCurves) {
    auto const parts =
        write("a.gpkg", {{.type = wkbMultiLineString, .rows = {{"MULTILINESTRING((0 0,1 1),(5 5,6 6,7 7))"}}}});
    auto const rivers = io::read_rivers({.path = parts});
    ASSERT_EQ(rivers.lines.size(), 2U);
    EXPECT_EQ(rivers.lines[1].feature, 1);
    EXPECT_EQ(rivers.lines[1].vertices.size(), 3U);
    auto const curve = write(
        "b.gpkg", {{.type = wkbCompoundCurve, .rows = {{"COMPOUNDCURVE(CIRCULARSTRING(0 0,1 1,2 0),(2 0,3 0))"}}}});
    auto const bent = io::read_rivers({.path = curve}).lines.at(0);
    EXPECT_GT(bent.vertices.size(), 10U);
    for (auto const p : in_plan(bent)) {
        EXPECT_TRUE(p.x > 2.0 || std::fabs(distance(p, {1, 0}) - 1.0) < 1e-6);
    }
    EXPECT_EQ(in_plan(bent).back(), (Vec2{3, 0}));
    auto const bends =
        write("c.gpkg", {{.type = wkbMultiCurve, .rows = {{"MULTICURVE((0 0,1 1),CIRCULARSTRING(5 0,6 1,7 0))"}}}});
    EXPECT_EQ(io::read_rivers({.path = bends}).lines.size(), 2U);
}

TEST_F(ReadRivers, HeightsAreKeptAndMeasuresIgnored) {
    auto const file = write("a.gpkg", {{.type = wkbLineStringZM, .rows = {{"LINESTRING ZM(0 0 9.5 1,1 1 8.25 2)"}}}});
    auto const rivers = io::read_rivers({.path = file});
    EXPECT_TRUE(rivers.has_z);
    EXPECT_EQ(rivers.lines[0].vertices, (std::vector<Vec3>{{0, 0, 9.5}, {1, 1, 8.25}}));
    auto const level = write("b.gpkg", {{.type = wkbLineString25D, .rows = {{"LINESTRING Z(0 0 0,1 1 0)"}}}});
    EXPECT_FALSE(io::read_rivers({.path = level}).has_z);
    auto const measured = write("c.gpkg", {{.type = wkbLineStringM, .rows = {{"LINESTRING M(0 0 3,1 1 2)"}}}});
    EXPECT_FALSE(io::read_rivers({.path = measured}).has_z);
    auto const moved = io::read_rivers({.path = file, .crs = "EPSG:32632"}); // heights stay where the plan moves
    EXPECT_EQ(moved.lines[0].vertices[0].z, 9.5);
}

TEST_F(ReadRivers, FieldsOfTypeAndRank) {
    char const* const fields = "Rosgen:s HYDROSEQ:r seq kind:s";
    std::vector<std::string> const values{"B4|10133922|3|c", "|||"};
    auto const rivers = with_fields(fields, values);
    EXPECT_EQ(all(rivers, &RiverLine::type), (std::vector<std::string>{"B4", ""}));
    EXPECT_EQ(all(rivers, &RiverLine::rank), (std::vector<std::int64_t>{10133922, 0}));
    auto const other = with_fields(fields, values, {.type_field = "kind", .rank_field = "seq"});
    EXPECT_EQ(other.lines[0].type, "c");
    EXPECT_EQ(other.lines[0].rank, 3);
}

TEST_F(ReadRivers, FieldOfLambda) {
    for (std::string const field : {"lambda", "LAMBDA:l", "Lambda:r", "lambda:s"}) {
        auto const file = write("a.gpkg", {{.type = wkbUnknown,
                                            .fields = field.c_str(),
                                            .rows = {{"LINESTRING(0 0,1 1)", "1"},
                                                     {"MULTILINESTRING((0 5,1 5),(2 5,3 5))", "50"},
                                                     {"LINESTRING(1 1,2 1)"}}}});
        EXPECT_EQ(all(io::read_rivers({.path = file}), &RiverLine::lambda), (std::vector<int>{1, 50, 50, 0})) << field;
        EXPECT_EQ(io::read_rivers({.path = file, .lambda_field = ""}).lines[0].lambda, 0);
    }
    EXPECT_EQ(with_fields("gen", {"3"}).lines[0].lambda, 0);
    EXPECT_EQ(with_fields("gen", {"3"}, {.lambda_field = "GEN"}).lines[0].lambda, 3);
    for (auto const& [field, lambda] : std::vector<std::pair<char const*, std::string>>{{"Lambda", "0"},
                                                                                        {"Lambda", "-1"},
                                                                                        {"Lambda", "51"},
                                                                                        {"Lambda:r", "2.5"},
                                                                                        {"Lambda:r", "1e300"},
                                                                                        {"Lambda:s", "few"},
                                                                                        {"Lambda:s", "2 3"}}) {
        EXPECT_TRUE(has(test::error_of([&] {
                            with_fields(field, {"2", lambda});
                        }),
                        "BadInput io.read_rivers", "feature 2 of fields.gpkg, which begins at (0, 10)"))
            << lambda;
    }
}

TEST(Walker, IsReadWhole) {
    auto const rivers = io::read_rivers(
        {.path = THALWEG_SOURCE_DIR "/samples/walker_nhdplus.gpkg"}); // ogrinfo: 62 features, 206 vertices, no Z
    EXPECT_EQ(rivers.crs, "EPSG:32610");
    EXPECT_FALSE(rivers.has_z);
    ASSERT_EQ(rivers.lines.size(), 62U);
    std::size_t vertices = 0;
    for (auto const& line : rivers.lines) {
        vertices += line.vertices.size();
        EXPECT_GT(line.rank, 10000000);
    }
    EXPECT_EQ(vertices, 206U);
}

} // namespace read_rivers_test
