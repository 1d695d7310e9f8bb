// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/internal/polygonise.hpp>

#include <algorithm>
#include <string>

#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>

namespace thalweg::io {

namespace {

constexpr std::int32_t none = -1;

void require_numbers(Raster<std::int32_t> const& numbers, std::int64_t count, std::string const& what) {
    auto const values = numbers.values();
    auto const beyond = std::find_if(values.begin(), values.end(), [&](std::int32_t n) { return n >= count; });
    if (beyond != values.end()) {
        Cell const c = numbers.grid().at(beyond - values.begin());
        throw BadInput(fmt::format("{}: {} at column {}, row {} is not one of {}", what, *beyond, c.col, c.row, count));
    }
}

Dataset in_memory(Raster<std::int32_t> const& numbers, std::string const& what) {
    require_size(numbers.grid(), what);
    Dataset dataset(GetGDALDriverManager()->GetDriverByName("MEM")->Create(
        "", static_cast<int>(numbers.width()), static_cast<int>(numbers.height()), 1, GDT_Int32, nullptr));
    if (dataset == nullptr) {
        throw IoError(fmt::format("{}: no memory for {} x {} cells", what, numbers.width(), numbers.height()));
    }
    set_frame(*dataset, numbers.grid());
    GDALRasterBand& band = *dataset->GetRasterBand(1);
    band.SetNoDataValue(none);
    std::vector<std::int32_t> line(static_cast<std::size_t>(numbers.width()));
    for (std::int64_t row = 0; row < numbers.height(); ++row) {
        auto const from = numbers.row(row);
        std::transform(from.begin(), from.end(), line.begin(), [](std::int32_t n) { return std::max(n, none); });
        if (band.RasterIO(GF_Write, 0, static_cast<int>(row), static_cast<int>(numbers.width()), 1, line.data(),
                          static_cast<int>(numbers.width()), 1, GDT_Int32, 0, 0, nullptr) != CE_None) {
            throw IoError(what + ": no copy in memory");
        }
    }
    return dataset;
}

Polygon taken(OGRPolygon const& drawn, std::int64_t number) {
    Polygon polygon{number, {}};
    for (auto const* const ring : drawn) {
        std::vector<Vec2> positions;
        for (int i = 0; i + 1 < ring->getNumPoints(); ++i) { // the last is the first
            positions.push_back({ring->getX(i), ring->getY(i)});
        }
        polygon.rings.push_back(std::move(positions));
    }
    return polygon;
}

} // namespace

std::vector<std::vector<Polygon>> polygonise(Raster<std::int32_t> const& numbers, std::int64_t count, Run const& run) {
    std::string const what = "io.polygonise";
    require_numbers(numbers, count, what);
    Driver const driver;
    Dataset const source = in_memory(numbers, what);
    Dataset const drawn(GetGDALDriverManager()->GetDriverByName("Memory")->Create("", 0, 0, 0, GDT_Unknown, nullptr));
    OGRLayer* const layer = drawn->CreateLayer("polygons", nullptr, wkbPolygon, nullptr);
    OGRFieldDefn field("number", OFTInteger);
    layer->CreateField(&field);
    GDALRasterBand& band = *source->GetRasterBand(1);
    Watch watch(run, "outline");
    CPLErr const error = GDALPolygonize(GDALRasterBand::ToHandle(&band), GDALRasterBand::ToHandle(band.GetMaskBand()),
                                        OGRLayer::ToHandle(layer), 0, nullptr, &Watch::step, &watch);
    watch.settle();
    driver.check(what);
    if (error != CE_None) {
        throw IoError(what + " failed");
    }
    Indexed<std::int64_t, std::vector<Polygon>> polygons(count);
    for (auto const& feature : *layer) {
        auto const number = feature->GetFieldAsInteger64(0);
        polygons[number].push_back(taken(*feature->GetGeometryRef()->toPolygon(), number));
    }
    driver.check(what); // an allocation that fails ends the loop, too
    return polygons;
}

} // namespace thalweg::io
