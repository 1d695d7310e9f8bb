// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/polylines.hpp>
#include <thalweg/io/raster/polygons.hpp>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <ogrsf_frmts.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/io/raster/internal/polygons.hpp>
#include <thalweg/io/raster/raster_files.hpp>

#include "vector_files.hpp"

namespace polygons_test {

using namespace thalweg;
using io::CatchmentRow;
using io::polygonise;

namespace {

using test::error_of;
using test::has;
using test::write;

Raster<std::int32_t> numbers_of(std::int64_t width, std::vector<std::int32_t> const& numbers) {
    Raster<std::int32_t> raster(
        Grid{width, static_cast<std::int64_t>(numbers.size()) / width, 10.0, 500000.0, 4000000.0, "EPSG:32631"});
    std::copy(numbers.begin(), numbers.end(), raster.values().begin());
    return raster;
}

OGRMultiPolygon drawn(std::vector<Polygon> const& parts) {
    OGRMultiPolygon shape;
    for (Polygon const& part : parts) {
        OGRPolygon polygon;
        for (auto const& positions : part.rings) {
            OGRLinearRing ring;
            for (Vec2 const p : positions) {
                ring.addPoint(p.x, p.y);
            }
            ring.closeRings();
            polygon.addRing(&ring);
        }
        shape.addGeometry(&polygon);
    }
    return shape;
}

/// Two catchments that touch in a corner and one around a cell of another, in two basins; one arc without cells.
struct Sample {
    Raster<std::int32_t> number = numbers_of(5, {0,  0, 1, 1, 1, //
                                                 0,  1, 0, 1, 3, //
                                                 -1, 1, 1, 1, 3, //
                                                 -1, 3, 3, 3, 3});
    std::vector<CatchmentRow> rows = {{11, 12, 1, 4, 4}, {12, 0, 1, 8, 12}, {13, 12, 1, 0, 0}, {14, 0, 7, 6, 6}};
};

std::vector<std::vector<double>> fields_of(std::string const& path, char const* layer,
                                           std::vector<char const*> const& names) {
    auto const file = opened(path);
    std::vector<std::vector<double>> rows;
    for (auto const& feature : *file->GetLayerByName(layer)) {
        auto& row = rows.emplace_back();
        for (char const* const name : names) {
            row.push_back(feature->GetFieldAsDouble(name));
        }
        OGRGeometry const* const shape = feature->GetGeometryRef();
        EXPECT_EQ(shape->getGeometryType(), wkbMultiPolygon);
        row.push_back(shape->toMultiPolygon()->get_Area());
        row.push_back(shape->toMultiPolygon()->getNumGeometries());
    }
    return rows;
}

/// A file of one feature, number 7, in a CRS.
std::string geojson(std::string const& geometry, std::string const& epsg = "32631") {
    std::string text = test::geojson(R"({"type":"Feature","id":7,"properties":{},"geometry":)" + geometry + "}");
    return text.replace(text.find("32631"), 5, epsg);
}

std::string const square =
    R"({"type":"Polygon","coordinates":[[[500000,0],[500100,0],[500100,100],[500000,100],[500000,0]],)"
    R"([[500020,20],[500040,20],[500040,40],[500020,20]]]})";

} // namespace

TEST(Polygonise, NoneAndOne) {
    EXPECT_TRUE(polygonise(numbers_of(2, {-1, -5}), 0).empty());
    auto const one = polygonise(numbers_of(1, {0}), 2);
    ASSERT_EQ(one.size(), 2U);
    EXPECT_TRUE(one[1].empty());
    ASSERT_EQ(one[0].size(), 1U);
    EXPECT_EQ(drawn(one[0]).get_Area(), 100.0);
    EXPECT_THROW(polygonise(numbers_of(2, {0, 2}), 2), BadInput);
    EXPECT_THROW(polygonise(Raster<std::int32_t>{}, 1), BadInput);
}

TEST(Polygonise, OutlinesHoldTheirCellsAndAreValid) {
    GDALAllRegister();
    ASSERT_TRUE(rc::check("a cell's centre lies inside the outlines of its number alone", [] {
        auto const width = *rc::gen::inRange<std::int64_t>(1, 9);
        auto const height = *rc::gen::inRange<std::int64_t>(1, 9);
        auto const count = *rc::gen::inRange(1, 4);
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        std::vector<std::int32_t> cells;
        for (std::int64_t i = 0; i < width * height; ++i) {
            auto const any = random_word(seed, static_cast<std::uint64_t>(i)) % static_cast<std::uint64_t>(count + 1);
            cells.push_back(static_cast<std::int32_t>(any) - 1);
        }
        auto const numbers = numbers_of(width, cells);
        auto const outlines = polygonise(numbers, count);
        RC_ASSERT(outlines.size() == static_cast<std::size_t>(count));
        for (std::int32_t n = 0; n < count; ++n) {
            OGRMultiPolygon const shape = drawn(outlines[static_cast<std::size_t>(n)]);
            RC_ASSERT(shape.IsValid());
            RC_ASSERT(shape.get_Area() == 100.0 * static_cast<double>(std::count(cells.begin(), cells.end(), n)));
            for (std::int64_t i = 0; i < numbers.cells(); ++i) {
                Vec2 const at = numbers.grid().centre(numbers.grid().at(i));
                OGRPoint const centre(at.x, at.y);
                RC_ASSERT((shape.Contains(&centre) != FALSE) == (numbers[i] == n));
            }
            for (Polygon const& part : outlines[static_cast<std::size_t>(n)]) {
                RC_ASSERT(part.feature == n);
                auto const& outer = part.rings.front();
                auto const west = [](Vec2 p, Vec2 q) { return p.x < q.x; };
                for (auto const& ring : part.rings) {
                    RC_ASSERT(std::ranges::min_element(ring, west)->x >= std::ranges::min_element(outer, west)->x);
                }
            }
        }
    }));
}

TEST(WriteCatchments, RowsAndShapes) {
    ScratchFolder const folder;
    Sample const s;
    io::CatchmentCount const count = io::write_catchments({s.number, s.rows}, folder / "catchments.gpkg");
    EXPECT_EQ(count.catchments, 3);
    EXPECT_EQ(count.parts, 4);
    EXPECT_EQ(count.basins, 2);
    EXPECT_EQ(fields_of(folder / "catchments.gpkg", "catchments",
                        {"arc_id", "ds_arc", "basin_id", "cells", "area", "ds_area"}),
              (std::vector<std::vector<double>>{{11, 12, 1, 4, 400, 400, 400, 2},
                                                {12, 0, 1, 8, 800, 1200, 800, 1},
                                                {14, 0, 7, 6, 600, 600, 600, 1}}));
    EXPECT_EQ(fields_of(folder / "catchments.gpkg", "basins", {"basin_id", "arcs", "cells", "area"}),
              (std::vector<std::vector<double>>{{1, 2, 12, 1200, 1200, 1}, {7, 1, 6, 600, 600, 1}}));
    io::write_catchments({s.number, s.rows}, folder / "again.gpkg");
    EXPECT_TRUE(bytes_of(folder / "catchments.gpkg") == bytes_of(folder / "again.gpkg"));
    EXPECT_THROW(io::write_catchments({s.number, s.rows}, folder / "again.gpkg"), IoError);
}

TEST(WriteCatchments, RefusesRowsOfOtherCells) {
    ScratchFolder const folder;
    Sample s;
    s.rows[3].cells = 5;
    EXPECT_TRUE(has(error_of([&] {
                        io::write_catchments({s.number, s.rows}, folder / "catchments.gpkg");
                    }),
                    "BadInput", "arc 14"));
    s.rows.pop_back();
    EXPECT_THROW(io::write_catchments({s.number, s.rows}, folder / "catchments.gpkg"), BadInput);
    EXPECT_EQ(folder.entries(), 0);
}

TEST(WriteCatchments, StopsWhenAsked) {
    ScratchFolder const folder;
    Sample const s;
    EXPECT_THROW(io::write_catchments({s.number, s.rows}, folder / "catchments.gpkg", test::stopped_run()), Cancelled);
}

TEST(ReadPolygons, RefusesNamingFileLayerAndFeature) {
    std::string const triangle = R"({"type":"Feature","id":1,"properties":{},"geometry":)"
                                 R"({"type":"Polygon","coordinates":[[[1,1],[2,1],[2,2],[1,1]]]}},)";
    for (auto const& [text, words] : std::vector<std::pair<std::string, std::string>>{
             {geojson(R"({"type":"LineString","coordinates":[[1,1],[2,2]]})"),
              "a.geojson has no layer of polygons (a)"},
             {"no file of shapes", "a.geojson"},
             {test::geojson(triangle + R"({"type":"Feature","id":2,"properties":{},"geometry":{"type":"Point",)"
                                       R"("coordinates":[1,1]}})"),
              "feature 2 of a.geojson is a Point"},
             {test::geojson(triangle + R"({"type":"Feature","id":5,"properties":{},"geometry":null})"),
              "feature 5 of a.geojson"},
             {geojson(R"({"type":"Polygon","coordinates":[[[1,1],[2,1],[2,95],[1,1]]]})", "4326"),
              "vertex 3 of feature 7 of a.geojson, (2, 95)"}}) {
        ScratchFolder const folder;
        write(folder / "a.geojson", text);
        EXPECT_TRUE(has(error_of([&] { io::read_polygons(folder / "a.geojson", "EPSG:32631"); }),
                        "BadInput io.read_polygons", words));
        EXPECT_FALSE(words.ends_with("(a)") && io::holds_polygons(folder / "a.geojson"));
    }
    ScratchFolder const folder;
    write(folder / "a.geojson", geojson(square));
    EXPECT_THROW(io::read_polygons(folder / "a.geojson", ""), BadInput);
    EXPECT_THROW(io::read_polygons(folder / "none.gpkg", "EPSG:32631"), BadInput);
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

TEST(ReadPolygons, TakesNumbersThatAreThere) {
    std::string const ring = "[500000,0],[500100,0],[500100,100],[500000,0]";
    auto const values = [&](std::string const& features) {
        ScratchFolder const folder;
        write(folder / "a.geojson", test::geojson(features));
        std::vector<double> found;
        for (Polygon const& one : io::read_polygons_valued(folder / "a.geojson", "EPSG:32631", "level").polygons) {
            found.push_back(std::isnan(one.value) ? -1.0 : one.value);
        }
        return found;
    };
    auto const polygon = [&](std::string const& properties) { return test::polygon(ring, properties); };
    EXPECT_EQ(values(polygon("\"Level\":12.5") + "," + polygon("\"Level\":null") + "," + polygon("")),
              (std::vector<double>{12.5, -1.0, -1.0}));
    EXPECT_EQ(values(polygon("\"level\":null")), std::vector<double>{-1.0});
    EXPECT_EQ(values(polygon("\"name\":\"a\"")), std::vector<double>{-1.0});
    EXPECT_EQ(values(polygon("\"LEVEL\":7")), std::vector<double>{7.0});
    EXPECT_TRUE(has(error_of([&] { values(polygon("\"level\":\"high\"")); }), "BadInput",
                    "no finite value in the field level"));
}

TEST(ReadPolygons, BringsPartsIntoTheGridsCrs) {
    ScratchFolder const folder;
    // On the equator at the zone's middle meridian, a thousandth of a degree wide.
    write(folder / "b.geojson",
          geojson(R"({"type":"MultiPolygon","coordinates":[[[[3,0],[3.001,0],[3.001,0.001],[3,0]]],)"
                  R"([[[3,1],[3.001,1],[3.001,1.001],[3,1]]]]})",
                  "4326"));
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
          geojson(R"({"type":"Polygon","coordinates":[[[8,-3],[10,-3],[10,-1],[8,-3]]]})", "4326"));
    EXPECT_EQ(io::crs_for_polygons(folder / "degrees.geojson"), "EPSG:32732");
    EXPECT_THROW(io::crs_for_polygons(folder / "none.geojson"), BadInput);
}

TEST(ReadPolygons, ARasterHoldsNone) {
    ScratchFolder const folder;
    io::write_mask(Mask(Grid{3, 3, 1.0, 0.0, 0.0, ""}, 1), folder / "m.tif");
    EXPECT_FALSE(io::holds_polygons(folder / "m.tif"));
    EXPECT_THROW(io::holds_polygons(folder / "none.tif"), BadInput);
}

TEST(United, TouchingPolygonsAreOneAndBowTiesAreMended) {
    std::vector<Polygon> const apart =
        io::united({{1, {{{0, 0}, {10, 0}, {10, 10}, {0, 10}}}}, {2, {{{20, 0}, {30, 0}, {30, 10}, {20, 10}}}}});
    ASSERT_EQ(apart.size(), 2U);
    EXPECT_EQ(apart[1].feature, 2);
    std::vector<Polygon> const one = io::united({{1, {{{100, 0}, {110, 0}, {110, 10}}}},
                                                 {5, {{{10, 0}, {20, 0}, {20, 10}, {10, 10}}}},
                                                 {3, {{{0, 0}, {10, 0}, {10, 10}, {0, 10}}}}});
    ASSERT_EQ(one.size(), 2U);
    EXPECT_EQ(one[1].feature, 5) << "the first in the file";
    EXPECT_DOUBLE_EQ(drawn({one[1]}).get_Area(), 200.0);
    std::vector<Polygon> const bow_tie = io::united({{4, {{{0, 0}, {10, 10}, {10, 0}, {0, 10}}}}});
    EXPECT_EQ(bow_tie.size(), 2U);
    OGRMultiPolygon const mended = drawn(bow_tie);
    EXPECT_TRUE(mended.IsValid());
    EXPECT_DOUBLE_EQ(mended.get_Area(), 50.0);
    EXPECT_TRUE(io::united({{6, {{{0, 0}, {1, 1}}}}}).empty());
    // Half a metre apart, and at a corner.
    std::vector<Polygon> const two{{1, {{{0, 0}, {100, 0}, {100, 100}, {0, 100}}}},
                                   {2, {{{100.5, 0}, {200, 0}, {200, 100}, {100.5, 100}}}},
                                   {3, {{{200, 100}, {300, 100}, {300, 200}, {200, 200}}}}};
    EXPECT_EQ(io::united(two).size(), 3U);
    std::vector<Polygon> const sheets = io::united(two, 1.0);
    ASSERT_EQ(sheets.size(), 1U);
    EXPECT_EQ(sheets[0].feature, 1);
    EXPECT_NEAR(std::fabs(geometry::signed_area(sheets[0].rings[0])), 29'950.0 + 50.0, 2.0);
    EXPECT_EQ(io::united(two, 0.2).size(), 2U) << "the corner alone";
}

} // namespace polygons_test
