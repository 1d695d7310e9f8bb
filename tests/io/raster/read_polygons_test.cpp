// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/polygons.hpp>

#include <cmath>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/raster/raster_files.hpp>

#include "scratch_folder.hpp"

namespace read_polygons_test {

using namespace thalweg;

namespace {

using test::has;
using test::message_of;
using test::write;

std::string geojson(std::string const& geometry, int epsg = 32631) {
    return R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::)" +
           std::to_string(epsg) + R"("}},"features":[{"type":"Feature","id":7,"properties":{},"geometry":)" + geometry +
           "}]}";
}

std::string const square =
    R"({"type":"Polygon","coordinates":[[[500000,0],[500100,0],[500100,100],[500000,100],[500000,0]],)"
    R"([[500020,20],[500040,20],[500040,40],[500020,20]]]})";

std::string refused(std::string const& path, std::string const& crs = "EPSG:32631") {
    return message_of<BadInput>([&] { io::read_polygons(path, crs); });
}

} // namespace

TEST(ReadPolygons, RefusesNamingFileLayerAndFeature) {
    ScratchFolder const folder;
    EXPECT_TRUE(has(refused(folder / "none.gpkg"), "does not exist"));
    write(folder / "line.geojson", geojson(R"({"type":"LineString","coordinates":[[1,1],[2,2]]})"));
    EXPECT_TRUE(has(refused(folder / "line.geojson"), "line.geojson has no layer of polygons (line)"));
    EXPECT_FALSE(io::holds_polygons(folder / "line.geojson"));
    write(folder / "text.gpkg", "no file of shapes");
    EXPECT_TRUE(has(refused(folder / "text.gpkg"), "cannot be read"));
    write(folder / "two.geojson",
          R"({"type":"FeatureCollection","features":[{"type":"Feature","id":1,"properties":{},"geometry":)"
          R"({"type":"Polygon","coordinates":[[[1,1],[2,1],[2,2],[1,1]]]}},{"type":"Feature","id":2,"properties":{},)"
          R"("geometry":{"type":"Point","coordinates":[1,1]}}]})");
    EXPECT_TRUE(has(refused(folder / "two.geojson"), "feature 2 of two.geojson is a Point, not a polygon"));
    write(folder / "null.geojson",
          R"({"type":"FeatureCollection","features":[{"type":"Feature","id":1,"properties":{},"geometry":)"
          R"({"type":"Polygon","coordinates":[[[1,1],[2,1],[2,2],[1,1]]]}},{"type":"Feature","id":5,"properties":{},)"
          R"("geometry":null}]})");
    EXPECT_TRUE(has(refused(folder / "null.geojson"), "feature 5 of null.geojson has no polygon"));
    write(folder / "pole.geojson", geojson(R"({"type":"Polygon","coordinates":[[[1,1],[2,1],[2,95],[1,1]]]})", 4326));
    EXPECT_TRUE(has(refused(folder / "pole.geojson"), "vertex 3 of feature 7 of pole.geojson, (2, 95)"))
        << refused(folder / "pole.geojson");
    write(folder / "a.geojson", geojson(square));
    auto const text = refused(folder / "a.geojson", "");
    EXPECT_TRUE(has(text, "a.geojson has EPSG:32631, the grid has no CRS")) << text;
}

TEST(ReadPolygons, KeepsCoordinatesInTheSameCrs) {
    ScratchFolder const folder;
    write(folder / "a.geojson", geojson(square));
    EXPECT_TRUE(io::holds_polygons(folder / "a.geojson"));
    Polygons const read = io::read_polygons(folder / "a.geojson", "EPSG:32631");
    ASSERT_EQ(read.polygons.size(), 1U);
    EXPECT_EQ(read.polygons[0].feature, 7);
    EXPECT_EQ(read.crs, "EPSG:32631");
    EXPECT_EQ(read.name, "a.geojson");
    ASSERT_EQ(read.polygons[0].rings.size(), 2U);
    EXPECT_EQ(read.polygons[0].rings[0], (std::vector<Vec2>{{500000, 0}, {500100, 0}, {500100, 100}, {500000, 100}}));
    EXPECT_EQ(read.polygons[0].rings[1], (std::vector<Vec2>{{500020, 20}, {500040, 20}, {500040, 40}}));
}

TEST(ReadPolygons, BringsPartsIntoTheGridsCrs) {
    ScratchFolder const folder;
    // On the equator at the zone's middle meridian, a thousandth of a degree wide.
    write(folder / "b.geojson",
          geojson(R"({"type":"MultiPolygon","coordinates":[[[[3,0],[3.001,0],[3.001,0.001],[3,0]]],)"
                  R"([[[3,1],[3.001,1],[3.001,1.001],[3,1]]]]})",
                  4326));
    Polygons const read = io::read_polygons(folder / "b.geojson", "EPSG:32631");
    ASSERT_EQ(read.polygons.size(), 2U);
    Vec2 const east = read.polygons[0].rings[0][1];
    EXPECT_EQ((read.polygons[0].rings[0][0]), (Vec2{500000.0, 0.0}));
    EXPECT_NEAR(east.x, 500000.0 + 0.9996 * 111.319, 0.01);
    EXPECT_EQ(east.x, std::floor(east.x * 1e6 + 0.5) / 1e6);
    EXPECT_EQ(read.polygons[1].feature, 7);
}

TEST(ReadPolygons, TheCrsWhereNoneIsAskedIsMetric) {
    ScratchFolder const folder;
    write(folder / "metres.geojson", geojson(square));
    EXPECT_EQ(io::crs_for_polygons(folder / "metres.geojson"), "EPSG:32631");
    write(folder / "degrees.geojson",
          geojson(R"({"type":"Polygon","coordinates":[[[8,-3],[10,-3],[10,-1],[8,-3]]]})", 4326));
    EXPECT_EQ(io::crs_for_polygons(folder / "degrees.geojson"), "EPSG:32732");
    EXPECT_THROW(io::crs_for_polygons(folder / "none.geojson"), BadInput);
}

TEST(ReadPolygons, ARasterHoldsNone) {
    ScratchFolder const folder;
    io::write_mask(Mask(Grid{3, 3, 1.0, 0.0, 0.0, ""}, 1), folder / "m.tif");
    EXPECT_FALSE(io::holds_polygons(folder / "m.tif"));
    EXPECT_THROW(io::holds_polygons(folder / "none.tif"), BadInput);
}

} // namespace read_polygons_test
