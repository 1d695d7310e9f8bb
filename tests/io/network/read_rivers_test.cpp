// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/read_rivers.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <set>
#include <stop_token>

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/network/import/import_lines.hpp>

#include "scratch_folder.hpp"

namespace read_rivers_test {

using namespace thalweg;
namespace fs = std::filesystem;

namespace {

using test::has;

struct Feature {
    std::string wkt;
    std::map<std::string, std::string> fields = {};
};

struct Layer {
    std::string name = "rivers";
    OGRwkbGeometryType type = wkbLineString;
    int epsg = 32633; // 0 for none
    std::map<std::string, OGRFieldType> fields = {};
    std::vector<Feature> features = {};
};

class ReadRivers : public ::testing::Test {
protected:
    std::string path(std::string const& name) const { return folder_ / name; }

    std::string write(std::string const& name, std::vector<Layer> const& layers, char const* format = "GPKG") {
        io::Driver const driver;
        auto* const maker = GetGDALDriverManager()->GetDriverByName(format);
        GDALDatasetUniquePtr const data(maker->Create(path(name).c_str(), 0, 0, 0, GDT_Unknown, nullptr));
        for (auto const& layer : layers) {
            OGRSpatialReference crs;
            if (layer.epsg != 0) {
                crs.importFromEPSG(layer.epsg);
                crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
            }
            auto* const out =
                data->CreateLayer(layer.name.c_str(), layer.epsg != 0 ? &crs : nullptr, layer.type, nullptr);
            for (auto const& [field, type] : layer.fields) {
                OGRFieldDefn definition(field.c_str(), type);
                out->CreateField(&definition);
            }
            for (auto const& f : layer.features) {
                OGRFeature feature(out->GetLayerDefn());
                for (auto const& [field, value] : f.fields) {
                    feature.SetField(field.c_str(), value.c_str());
                }
                if (!f.wkt.empty()) {
                    OGRGeometry* geometry = nullptr;
                    OGRGeometryFactory::createFromWkt(f.wkt.c_str(), nullptr, &geometry);
                    feature.SetGeometryDirectly(geometry);
                }
                EXPECT_EQ(out->CreateFeature(&feature), OGRERR_NONE);
            }
        }
        return path(name);
    }

    std::string refusal(io::ReadRiversParams const& params) {
        return test::message_of<BadInput>([&] { io::read_rivers(params); });
    }

private:
    ScratchFolder folder_;
};

std::vector<Vec2> plan(RiverLine const& line) {
    std::vector<Vec2> result;
    for (auto const& v : line.vertices) {
        result.push_back({v.x, v.y});
    }
    return result;
}

Layer const two_rivers{
    .features = {{"LINESTRING(500000 5000000,500100 5000000.5)"}, {"LINESTRING(500100 5000000.5,500200 5000100)"}}};

} // namespace

TEST_F(ReadRivers, MissingFile) {
    EXPECT_TRUE(has(refusal({.path = path("none.gpkg")}), "there is no file '" + path("none.gpkg")));
    EXPECT_TRUE(has(refusal({.path = ""}), "there is no file ''"));
}

TEST_F(ReadRivers, NoVectorFile) {
    std::ofstream(path("text.gpkg")) << "this is no GeoPackage";
    EXPECT_TRUE(has(refusal({.path = path("text.gpkg")}), "is not a vector file"));
}

TEST_F(ReadRivers, EmptyLayer) {
    EXPECT_TRUE(has(refusal({.path = write("a.gpkg", {Layer{}})}), "layer rivers of a.gpkg is empty"));
}

TEST_F(ReadRivers, NoLayerOfLines) {
    auto const points = write("a.gpkg", {{.name = "wells", .type = wkbPoint, .features = {{"POINT(1 2)"}}}});
    EXPECT_TRUE(has(refusal({.path = points}), "a.gpkg has no layer with lines (wells)"));
    EXPECT_TRUE(has(refusal({.path = points, .layer = "wells"}), "a.gpkg, layer wells: it holds Point, not lines"));
    auto const only = write("b.gpkg", {{.type = wkbUnknown, .features = {{"POINT(1 2)"}, {"POINT(1 3)"}}}});
    EXPECT_TRUE(has(refusal({.path = only}), "b.gpkg has no layer with lines (rivers)"));
    EXPECT_TRUE(has(refusal({.path = only, .layer = "rivers"}), "layer rivers of b.gpkg holds no line"));
}

TEST_F(ReadRivers, ShapesThatAreNotLinesAreCounted) {
    auto const file = write("a.gpkg", {{.type = wkbUnknown,
                                        .features = {{"POINT(1 2)"},
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
    ASSERT_EQ(read.findings.size(), 3U);
    EXPECT_EQ(read.findings[0].kind, "not_a_line");
    EXPECT_EQ(read.findings[0].amount, 3.0);
    EXPECT_EQ(read.findings[0].where, (Vec2{1.0, 2.0}));
    EXPECT_EQ(read.findings[1].text, "1 shape of type Polygon is not a line and is skipped; it is in feature 2");
    EXPECT_EQ(read.findings[2].kind, "left_out");
}

TEST_F(ReadRivers, LayersByName) {
    auto other = two_rivers;
    other.name = "canals";
    auto const file = write("a.gpkg", {two_rivers, other, {.name = "wells", .type = wkbPoint}});
    EXPECT_EQ(io::read_rivers({.path = file}).lines.size(), 2U); // its name says which
    auto roads = two_rivers;
    roads.name = "roads";
    auto const unclear = write("c.gpkg", {other, roads});
    EXPECT_TRUE(has(refusal({.path = unclear}), "c.gpkg has 2 layers with lines (canals, roads)"));
    auto streams = two_rivers;
    streams.name = "Streams_2020";
    auto const two = write("d.gpkg", {two_rivers, streams});
    EXPECT_EQ(io::read_rivers({.path = two}).lines.size(), 2U); // rivers before streams
    auto more = two_rivers;
    more.name = "river_lines";
    EXPECT_TRUE(has(refusal({.path = write("e.gpkg", {two_rivers, more})}), "e.gpkg has 2 layers with lines"));
    EXPECT_TRUE(has(refusal({.path = file, .layer = "rivrs"}), "a.gpkg has no layer 'rivrs'"));
    EXPECT_FALSE(has(refusal({.path = file, .layer = "something"}), "Did you mean"));
    EXPECT_EQ(io::read_rivers({.path = file, .layer = "canals"}).lines.size(), 2U);
    auto const one = write("b.gpkg", {two_rivers, {.name = "wells", .type = wkbPoint}});
    EXPECT_EQ(io::read_rivers({.path = one}).lines.size(), 2U);
}

TEST_F(ReadRivers, NoCrs) {
    auto layer = two_rivers;
    layer.epsg = 0;
    auto const refused = refusal({.path = write("a.shp", {layer}, "ESRI Shapefile")});
    EXPECT_TRUE(has(refused, "layer a of a.shp has no CRS"));
    // A GeoPackage names what has no CRS "Undefined geographic SRS" or "Undefined Cartesian SRS".
    layer.name = "rivers";
    auto const file = write("b.gpkg", {layer});
    for (char const* const id : {"0", "-1"}) {
        GDALDatasetUniquePtr const data(GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR | GDAL_OF_UPDATE));
        for (char const* const table : {"gpkg_contents", "gpkg_geometry_columns"}) {
            data->ExecuteSQL((std::string("UPDATE ") + table + " SET srs_id = " + id).c_str(), nullptr, nullptr);
        }
        data->FlushCache();
        auto const words = refusal({.path = file, .crs = "EPSG:32633", .source_crs = ""});
        EXPECT_TRUE(has(words, "layer rivers of b.gpkg has no CRS"));
    }
}

TEST_F(ReadRivers, FieldsOfLinksCanBeNamed) {
    auto layer = two_rivers;
    layer.fields = {{"nummer", OFTInteger}, {"nach", OFTInteger}};
    layer.features[0].fields = {{"nummer", "7"}, {"nach", "9"}};
    layer.features[1].fields = {{"nummer", "9"}, {"nach", "0"}};
    auto const file = write("a.gpkg", {layer});
    EXPECT_EQ(io::read_rivers({.path = file}).lines[0].down, 0);
    auto const named = io::read_rivers({.path = file, .id_field = "Nummer", .down_field = "nach"});
    EXPECT_EQ(named.lines[0].down, 2);
    EXPECT_EQ(named.lines[1].down, 0);
    EXPECT_TRUE(has(refusal({.path = file, .id_field = "nummer", .down_field = "nah"}),
                    "has no field 'nah'. Did you mean 'nach'?"));
    EXPECT_THROW(io::read_rivers({.path = file, .id_field = "nummer"}), BadParameter);
}

TEST_F(ReadRivers, DirectionColumns) {
    auto const runs = [&](std::string const& field, OGRFieldType type, std::string const& first,
                          std::string const& second) {
        auto layer = two_rivers;
        layer.fields = {{field, type}};
        layer.features[0].fields = {{field, first}};
        layer.features[1].fields = {{field, second}};
        auto const rivers = io::read_rivers({.path = write(field + first + ".gpkg", {layer})});
        return std::pair(rivers.lines[0].runs, rivers.lines[1].runs);
    };
    EXPECT_EQ(runs("flowDirection", OFTString, "inDirection", "inOppositeDirection"), std::pair(1, -1));     // INSPIRE
    EXPECT_EQ(runs("flow_direction", OFTString, "in direction", "in opposite direction"), std::pair(1, -1)); // OS
    EXPECT_EQ(runs("flow", OFTString, "both directions", "in direction"), std::pair(0, 1));
    EXPECT_EQ(runs("SensEcoul", OFTString, "Sens inverse", "Sens direct"), std::pair(-1, 1)); // BD TOPAGE
    EXPECT_EQ(runs("SensEcoul", OFTString, "Double sens", "Inconnu"), std::pair(0, 0));
    EXPECT_EQ(runs("FLOWDIRECTION", OFTInteger, "1", "2"), std::pair(1, -1)); // NHN
    EXPECT_EQ(runs("FLOWDIRECTION", OFTInteger, "-1", "0"), std::pair(0, 0));
    EXPECT_EQ(runs("flow", OFTInteger, "1", "2"), std::pair(0, 0)); // a discharge, say
}

TEST_F(ReadRivers, ACrsThatIsMissingCanBeNamed) {
    auto layer = two_rivers;
    layer.name = "a";
    layer.epsg = 0;
    auto const bare = write("a.shp", {layer}, "ESRI Shapefile");
    auto const named = io::read_rivers({.path = bare, .source_crs = "EPSG:32633"});
    EXPECT_EQ(named.crs, "EPSG:32633");
    EXPECT_EQ(plan(named.lines[0]), (std::vector<Vec2>{{500000, 5000000}, {500100, 5000000.5}}));
    auto const moved = io::read_rivers({.path = bare, .crs = "EPSG:32632", .source_crs = "EPSG:32633"});
    EXPECT_EQ(moved.crs, "EPSG:32632");
    EXPECT_GT(moved.lines[0].vertices[0].x, 900000.0);
    layer.epsg = 32633;
    auto const own = io::read_rivers({.path = write("b.gpkg", {layer}), .source_crs = "EPSG:32632"});
    EXPECT_EQ(own.crs, "EPSG:32633");
    EXPECT_TRUE(has(refusal({.path = bare, .source_crs = "EPSG:x"}), "'EPSG:x' is not a coordinate system"));
    EXPECT_TRUE(has(refusal({.path = path("b.gpkg"), .source_crs = "EPSG:x"}), "'EPSG:x' is not a coordinate system"));
    layer.epsg = 0;
    layer.features = {{"LINESTRING Z(500000 5000000 100,500100 5000000 50)"}};
    layer.type = wkbLineString25D;
    auto const feet = io::read_rivers(
        {.path = write("a.shp", {layer}, "ESRI Shapefile"), .source_crs = "EPSG:32633+6360"}); // NAVD88 in US feet
    EXPECT_NEAR(feet.lines[0].vertices[0].z, 100.0 * 1200.0 / 3937.0, 1e-9);
}

TEST_F(ReadRivers, FeaturesWithoutALineAreLeftOut) {
    auto const some = io::read_rivers({.path = write("a.gpkg", {{.features = {{"LINESTRING(0 0,1 1)"},
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
    auto const none = write("b.gpkg", {{.features = {{"LINESTRING EMPTY"}}}});
    EXPECT_TRUE(has(refusal({.path = none}), "holds no line: feature 1 has no line of any length"));
}

TEST_F(ReadRivers, CoordinatesThatAreNotFinite) {
    for (double const bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        auto const file = write("a.shp", {two_rivers}, "ESRI Shapefile");
        auto shp = bytes_of(file);
        double const y = 5000100.0; // of the last vertex
        auto const place = shp.rfind(std::string(reinterpret_cast<char const*>(&y), sizeof y));
        ASSERT_NE(place, std::string::npos);
        shp.replace(place, sizeof bad, reinterpret_cast<char const*>(&bad), sizeof bad);
        std::ofstream(file, std::ios::binary) << shp;
        EXPECT_TRUE(has(refusal({.path = file}), "vertex 2 of feature 2 of a.shp is not finite"));
    }
}

TEST_F(ReadRivers, WhatCannotBeReprojected) {
    auto const file =
        write("a.gpkg", {{.epsg = 4326, .features = {{"LINESTRING(0 0,1 1)"}, {"LINESTRING(0 2,0 95)"}}}});
    auto const refused = refusal({.path = file, .crs = "EPSG:32631"});
    EXPECT_TRUE(has(refused, "vertex 2 of feature 2 of a.gpkg"));
    EXPECT_TRUE(has(refusal({.path = file, .crs = "EPSG:4326"}), "is geographic"));
    EXPECT_TRUE(has(refusal({.path = file, .crs = "nonsense"}), "is not a coordinate system"));
}

TEST_F(ReadRivers, CorruptFile) {
    std::vector<Feature> many;
    for (int i = 0; i < 3000; ++i) {
        many.push_back({"LINESTRING(0 0,1 1,2 " + std::to_string(i) + ",3 3,4 4,5 5,6 6)"});
    }
    auto const file = write("a.gpkg", {{.features = many}});
    auto bytes = bytes_of(file);
    // Pages in the middle of the table, past the schema.
    std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() / 3),
              bytes.begin() + static_cast<std::ptrdiff_t>(2 * bytes.size() / 3), '\x5a');
    std::ofstream(file, std::ios::binary) << bytes;
    EXPECT_THROW(io::read_rivers({.path = file}), Error);
}

TEST_F(ReadRivers, StopsWhenAsked) {
    std::stop_source source;
    source.request_stop();
    thalweg::Run run;
    run.stop = source.get_token();
    EXPECT_THROW(io::read_rivers({.path = write("a.gpkg", {two_rivers})}, run), Cancelled);
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
    EXPECT_EQ(plan(rivers.lines[0]), (std::vector<Vec2>{{500000, 5000000}, {500100, 5000000.5}}));
    EXPECT_TRUE(std::isnan(rivers.lines[0].vertices[0].z));
}

TEST_F(ReadRivers, EveryFormatGivesTheSame) {
    auto const expected = io::read_rivers({.path = write("a.gpkg", {two_rivers})});
    std::vector<std::pair<std::string, char const*>> const formats{
        {"a.shp", "ESRI Shapefile"}, {"a.fgb", "FlatGeobuf"}, {"a.geojson", "GeoJSON"}};
    for (auto const& [name, format] : formats) {
        auto const rivers = io::read_rivers({.path = write(name, {two_rivers}, format)});
        EXPECT_EQ(rivers.crs, "EPSG:32633") << format;
        ASSERT_EQ(rivers.lines.size(), 2U) << format;
        auto plans = std::vector{plan(rivers.lines[0]), plan(rivers.lines[1])};
        std::ranges::sort(plans, {}, [](auto const& p) { return p.front().x; }); // FlatGeobuf orders by place
        EXPECT_EQ(plans[0], plan(expected.lines[0])) << format;
        EXPECT_EQ(plans[1], plan(expected.lines[1])) << format;
    }
}

TEST_F(ReadRivers, GeographicGoesToItsUtmZone) {
    // On the central meridian of zone 33 x is 500 km; y of 45 degrees north times the scale 0.9996.
    auto const file = write("a.gpkg", {{.epsg = 4326, .features = {{"LINESTRING(15 45,15 45.01)"}}}});
    auto const rivers = io::read_rivers({.path = file});
    EXPECT_EQ(rivers.crs, "EPSG:32633");
    EXPECT_EQ(rivers.lines[0].vertices[0].x, 500000.0);
    EXPECT_NEAR(rivers.lines[0].vertices[0].y, 4982950.4, 0.1);
    EXPECT_EQ(
        io::read_rivers({.path = write("b.gpkg", {{.epsg = 4326, .features = {{"LINESTRING(15 -45,15 -45.01)"}}}})})
            .crs,
        "EPSG:32733");
}

TEST_F(ReadRivers, WideExtentsGoToAnEqualAreaProjection) {
    // 10 degrees around the middle: a zone; 25 degrees, and lengths in it would be up to 5 % too long.
    auto const zone = write("a.gpkg", {{.epsg = 4326, .features = {{"LINESTRING(0 45,20 45)"}}}});
    EXPECT_EQ(io::read_rivers({.path = zone}).crs, "EPSG:32632");
    auto const wide = write("b.gpkg", {{.epsg = 4326, .features = {{"LINESTRING(-10 48,40 48)"}}}});
    auto const rivers = io::read_rivers({.path = wide});
    EXPECT_TRUE(has(rivers.crs, "Equal area around 15, 48"));
    auto const& line = rivers.lines[0].vertices;
    EXPECT_NEAR(line.front().x, -line.back().x, 1e-5); // the middle is the origin
    EXPECT_EQ(io::projected_crs(rivers.crs), rivers.crs);
    EXPECT_EQ(io::read_rivers({.path = wide, .crs = "EPSG:3035"}).crs, "EPSG:3035");
    // As far at 70 degrees north is less far.
    auto const north = write("c.gpkg", {{.epsg = 4326, .features = {{"LINESTRING(-5 70,35 70)"}}}});
    EXPECT_EQ(io::read_rivers({.path = north}).crs, "EPSG:32633");
    auto const globe = write(
        "d.gpkg",
        {{.epsg = 4326,
          .features = {{"LINESTRING(-170 60,-169 61)"}, {"LINESTRING(-50 60,-51 61)"}, {"LINESTRING(70 60,71 61)"}}}});
    std::string const refused = refusal({.path = globe});
    EXPECT_TRUE(has(refused, "over 240 degrees of longitude") && has(refused, "--crs")) << refused;
}

TEST_F(ReadRivers, MetresThatAreNoneGoToTheUtmZone) {
    // Some 10 km of the meridian at 47 degrees north, where a metre of Web Mercator is 0.68 m.
    auto const file = write(
        "a.gpkg", {{.epsg = 3857, .features = {{"LINESTRING(1001875.417 5934492.151,1001875.417 5949180.027)"}}}});
    auto const rivers = io::read_rivers({.path = file});
    EXPECT_EQ(rivers.crs, "EPSG:32632");
    auto const& v = rivers.lines[0].vertices;
    EXPECT_NEAR(v[0].x, 500000.0, 0.1);
    EXPECT_NEAR(distance({v[0].x, v[0].y}, {v[1].x, v[1].y}), 10000.0, 40.0);
    auto const kept = io::read_rivers({.path = file, .crs = "EPSG:3857"});
    EXPECT_EQ(kept.crs, "EPSG:3857");
    EXPECT_EQ(kept.lines[0].vertices[1].y, 5949180.027);
}

TEST_F(ReadRivers, FeetGoToTheUtmZone) {
    auto const file = write("a.gpkg", {{.epsg = 2225, .features = {{"LINESTRING(6561666 1640416,6561966 1640416)"}}}});
    auto const rivers = io::read_rivers({.path = file});
    EXPECT_EQ(rivers.crs, "EPSG:32610");
    auto const& v = rivers.lines[0].vertices;
    EXPECT_NEAR(distance({v[0].x, v[0].y}, {v[1].x, v[1].y}), 300 * 0.3048, 0.1);
}

TEST_F(ReadRivers, AnotherCrsOnRequest) {
    auto const file = write("a.gpkg", {two_rivers});
    auto const rivers = io::read_rivers({.path = file, .crs = "EPSG:25833"}); // ETRS89: the same to the millimetre
    EXPECT_EQ(rivers.crs, "EPSG:25833");
    EXPECT_NEAR(rivers.lines[0].vertices[0].x, 500000.0, 1e-3);
    EXPECT_NEAR(rivers.lines[0].vertices[0].y, 5000000.0, 1e-3);
}

TEST_F(ReadRivers, CoordinatesAreRounded) {
    auto const file = write("a.gpkg", {{.features = {{"LINESTRING(0.12345678 -0.0000004,1.0000005 1)"}}}});
    EXPECT_EQ(plan(io::read_rivers({.path = file}).lines[0]), (std::vector<Vec2>{{0.123457, 0.0}, {1.000001, 1.0}}));
}

TEST_F(ReadRivers, PartsAndCurves) {
    auto const parts =
        write("a.gpkg", {{.type = wkbMultiLineString, .features = {{"MULTILINESTRING((0 0,1 1),(5 5,6 6,7 7))"}}}});
    auto const rivers = io::read_rivers({.path = parts});
    ASSERT_EQ(rivers.lines.size(), 2U);
    EXPECT_EQ(rivers.lines[1].feature, 1);
    EXPECT_EQ(rivers.lines[1].vertices.size(), 3U);
    auto const curve = write(
        "b.gpkg", {{.type = wkbCompoundCurve, .features = {{"COMPOUNDCURVE(CIRCULARSTRING(0 0,1 1,2 0),(2 0,3 0))"}}}});
    auto const bent = io::read_rivers({.path = curve}).lines.at(0);
    EXPECT_GT(bent.vertices.size(), 10U);
    for (auto const p : plan(bent)) {
        EXPECT_TRUE(p.x > 2.0 || std::fabs(distance(p, {1, 0}) - 1.0) < 1e-6);
    }
    EXPECT_EQ(plan(bent).back(), (Vec2{3, 0}));
    auto const bends =
        write("c.gpkg", {{.type = wkbMultiCurve, .features = {{"MULTICURVE((0 0,1 1),CIRCULARSTRING(5 0,6 1,7 0))"}}}});
    EXPECT_EQ(io::read_rivers({.path = bends}).lines.size(), 2U);
}

TEST_F(ReadRivers, HeightsAreKeptAndMeasuresIgnored) {
    auto const file =
        write("a.gpkg", {{.type = wkbLineStringZM, .features = {{"LINESTRING ZM(0 0 9.5 1,1 1 8.25 2)"}}}});
    auto const rivers = io::read_rivers({.path = file});
    EXPECT_TRUE(rivers.has_z);
    EXPECT_EQ(rivers.lines[0].vertices, (std::vector<Vec3>{{0, 0, 9.5}, {1, 1, 8.25}}));
    auto const level = write("b.gpkg", {{.type = wkbLineString25D, .features = {{"LINESTRING Z(0 0 0,1 1 0)"}}}});
    EXPECT_FALSE(io::read_rivers({.path = level}).has_z);
    auto const measured = write("c.gpkg", {{.type = wkbLineStringM, .features = {{"LINESTRING M(0 0 3,1 1 2)"}}}});
    EXPECT_FALSE(io::read_rivers({.path = measured}).has_z);
    auto const moved = io::read_rivers({.path = file, .crs = "EPSG:32632"}); // heights stay where the plan moves
    EXPECT_EQ(moved.lines[0].vertices[0].z, 9.5);
}

TEST_F(ReadRivers, FieldsOfTypeAndRank) {
    Layer const layer{
        .fields = {{"Rosgen", OFTString}, {"HYDROSEQ", OFTReal}, {"seq", OFTInteger}, {"kind", OFTString}},
        .features = {{"LINESTRING(0 0,1 1)", {{"Rosgen", "B4"}, {"HYDROSEQ", "10133922"}, {"seq", "3"}, {"kind", "c"}}},
                     {"LINESTRING(1 1,2 1)", {}}}};
    auto const file = write("a.gpkg", {layer});
    auto const rivers = io::read_rivers({.path = file});
    EXPECT_EQ(rivers.lines[0].type, "B4");
    EXPECT_EQ(rivers.lines[0].rank, 10133922);
    EXPECT_EQ(rivers.lines[1].type, "");
    EXPECT_EQ(rivers.lines[1].rank, 0);
    auto const named = io::read_rivers({.path = file, .type_field = "kind", .rank_field = "seq"});
    EXPECT_EQ(named.lines[0].type, "c");
    EXPECT_EQ(named.lines[0].rank, 3);
    EXPECT_TRUE(has(refusal({.path = file, .type_field = "kint"}), "layer rivers of a.gpkg has no field 'kint'"));
    EXPECT_TRUE(has(refusal({.path = file, .rank_field = "order"}), "has no field 'order'"));
    EXPECT_TRUE(has(refusal({.path = file, .rank_field = "kind"}), "field kind of a.gpkg is not a number field"));
    auto broken = layer;
    broken.features[0].fields["HYDROSEQ"] = "1.5";
    EXPECT_TRUE(has(refusal({.path = write("b.gpkg", {broken})}), "feature 1 of b.gpkg has the rank 1.5"));
}

TEST_F(ReadRivers, LambdaThatIsNoGenerator) {
    auto const file_with = [&](OGRFieldType type, std::string const& lambda) {
        return write("a.gpkg", {{.fields = {{"Lambda", type}},
                                 .features = {{"LINESTRING(0 0,1 1)", {{"Lambda", "2"}}},
                                              {"LINESTRING(1.5 2,2 1)", {{"Lambda", lambda}}}}}});
    };
    std::vector<std::pair<OGRFieldType, std::string>> const wrong{
        {OFTInteger, "0"},  {OFTInteger, "-1"}, {OFTInteger, "51"}, {OFTReal, "2.5"},
        {OFTReal, "1e300"}, {OFTString, "few"}, {OFTString, "2 3"}, {OFTString, ""}};
    for (auto const& [type, lambda] : wrong) {
        auto const refused = refusal({.path = file_with(type, lambda)});
        EXPECT_TRUE(has(refused, "feature 2 of a.gpkg, which begins at (1.5, 2), has the Lambda '" +
                                     (lambda == "1e300" ? "1e+300" : lambda) + "': a whole number from 1 to 50"));
    }
    EXPECT_TRUE(has(refusal({.path = write("b.gpkg", {two_rivers}), .lambda_field = "number"}),
                    "layer rivers of b.gpkg has no field 'number'"));
}

TEST_F(ReadRivers, FieldOfLambda) {
    for (char const* const field : {"lambda", "LAMBDA", "Lambda"}) {
        for (auto const type : {OFTInteger, OFTInteger64, OFTReal, OFTString}) {
            auto const file = write("a.gpkg", {{.type = wkbUnknown,
                                                .fields = {{field, type}},
                                                .features = {{"LINESTRING(0 0,1 1)", {{field, "1"}}},
                                                             {"MULTILINESTRING((0 5,1 5),(2 5,3 5))", {{field, "50"}}},
                                                             {"LINESTRING(1 1,2 1)", {}}}}});
            auto const rivers = io::read_rivers({.path = file});
            ASSERT_EQ(rivers.lines.size(), 4U);
            EXPECT_EQ(rivers.lines[0].lambda, 1);
            EXPECT_EQ(rivers.lines[1].lambda, 50);
            EXPECT_EQ(rivers.lines[2].lambda, 50);
            EXPECT_EQ(rivers.lines[3].lambda, 0);
            EXPECT_EQ(io::read_rivers({.path = file, .lambda_field = ""}).lines[0].lambda, 0);
        }
    }
    auto const other =
        write("b.gpkg", {{.fields = {{"gen", OFTInteger}}, .features = {{"LINESTRING(0 0,1 1)", {{"gen", "3"}}}}}});
    EXPECT_EQ(io::read_rivers({.path = other}).lines[0].lambda, 0);
    EXPECT_EQ(io::read_rivers({.path = other, .lambda_field = "GEN"}).lines[0].lambda, 3);
}

namespace {

RiverLines walker() {
    return io::read_rivers({.path = THALWEG_SOURCE_DIR "/samples/walker_nhdplus.gpkg"});
}

} // namespace

TEST_F(ReadRivers, AcrossTheMeridianOf180Degrees) {
    auto const file =
        write("a.gpkg",
              {{.epsg = 4326,
                .features = {{"LINESTRING (179.98 -16, -179.99 -16)"}, {"LINESTRING (-179.99 -16, -179.97 -16.01)"}}}});
    RiverLines const lines = io::read_rivers({.path = file, .type_field = ""});
    EXPECT_EQ(lines.crs, "EPSG:32701");
    auto const& first = lines.lines[0].vertices;
    EXPECT_NEAR(first[1].x - first[0].x, 3210.0, 8.0);
}

TEST_F(ReadRivers, ACrsThatDoesNotExist) {
    std::string const file = path("a.geojson");
    std::ofstream(file) << R"({"type":"FeatureCollection","crs":{"type":"name","properties":)"
                        << R"({"name":"urn:ogc:def:crs:EPSG::99999"}},"features":[{"type":"Feature","properties":{},)"
                        << R"("geometry":{"type":"LineString","coordinates":[[500000,5000000],[501000,5001000]]}}]})";
    EXPECT_TRUE(has(test::message_of<BadInput>([&] { io::read_rivers({.path = file, .type_field = ""}); }),
                    "it names a CRS that does not exist"));
}

TEST(Walker, IsReadWhole) {
    auto const rivers = walker(); // ogrinfo: 62 features, 206 vertices, no Z
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

TEST(Walker, BecomesOneTree) {
    auto const rivers = walker();
    auto const imported = network::import_lines(rivers);
    ASSERT_EQ(imported.network.outlets().size(), 1U);
    EXPECT_EQ(imported.network.node_count(), imported.network.arc_count() + 1);
    EXPECT_EQ(imported.network.arc_count(), 51U); // 62 reaches, of which 11 go on where no other joins
    EXPECT_EQ(imported.repairs.size(), 11U);
    EXPECT_TRUE(std::ranges::all_of(imported.repairs, [](Finding const& f) { return f.kind == "joined"; }));
    // The last reach of Walker Creek is feature 1 (TerminalFl = 1), drawn downstream.
    auto const mouth = rivers.lines[0].vertices.back();
    EXPECT_EQ(imported.network.node(imported.network.outlets()[0]).at, (Vec2{mouth.x, mouth.y}));
}

TEST(Walker, KeepsEveryVertexInOrder) {
    auto const rivers = walker();
    auto const imported = network::import_lines(rivers);
    std::set<std::pair<std::pair<double, double>, std::pair<double, double>>> steps;
    for (ArcId a = 0; a < imported.network.arc_count(); ++a) {
        auto const& line = imported.network.arc(a).line;
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            steps.insert({{line[i].x, line[i].y}, {line[i + 1].x, line[i + 1].y}});
        }
    }
    std::size_t drawn = 0;
    for (auto const& line : rivers.lines) {
        for (std::size_t i = 0; i + 1 < line.vertices.size(); ++i, ++drawn) {
            auto const& a = line.vertices[i];
            auto const& b = line.vertices[i + 1];
            EXPECT_TRUE(steps.contains({{a.x, a.y}, {b.x, b.y}})) << "river " << line.feature << " vertex " << i;
        }
    }
    EXPECT_EQ(steps.size(), drawn); // nothing is added, nothing drawn twice
}

TEST(Walker, EveryEvidenceSaysTheSame) {
    auto const rivers = walker();
    auto const outlet = [&](network::Orientation orientation) {
        auto const imported = network::import_lines(rivers, {.orientation = orientation});
        return imported.network.node(imported.network.outlets().at(0)).at;
    };
    EXPECT_EQ(outlet(network::Orientation::rank), outlet(network::Orientation::as_drawn));
    EXPECT_EQ(outlet(network::Orientation::rank), outlet(network::Orientation::automatic));
}

} // namespace read_rivers_test
