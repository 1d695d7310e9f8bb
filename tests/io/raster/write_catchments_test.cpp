// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/polygons.hpp>

#include <algorithm>
#include <memory>

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/io/raster/internal/polygons.hpp>

#include "scratch_folder.hpp"

namespace write_catchments_test {

using namespace thalweg;
using io::CatchmentRow;
using io::polygonise;

namespace {

using test::has;
using test::message_of;

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
    GDALAllRegister();
    std::unique_ptr<GDALDataset> const file(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR));
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
    EXPECT_TRUE(has(message_of<BadInput>([&] {
                        io::write_catchments({s.number, s.rows}, folder / "catchments.gpkg");
                    }),
                    "arc 14 has 6 cells, its row says 5"));
    s.rows.pop_back();
    EXPECT_THROW(io::write_catchments({s.number, s.rows}, folder / "catchments.gpkg"), BadInput);
    EXPECT_EQ(folder.entries(), 0);
}

TEST(WriteCatchments, StopsWhenAsked) {
    ScratchFolder const folder;
    Sample const s;
    thalweg::Run run;
    run.progress = [](double, char const*, void*) { return 0; };
    EXPECT_THROW(io::write_catchments({s.number, s.rows}, folder / "catchments.gpkg", run), Cancelled);
}

} // namespace write_catchments_test
