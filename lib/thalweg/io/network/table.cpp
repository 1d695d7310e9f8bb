// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/table.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/by_enum.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/network/internal/layer_writer.hpp>

namespace thalweg::io {

namespace {

struct FileFormat {
    char const* word;   // as messages name it
    char const* driver; // as GDAL does
};

// In the order of LayerFormat.
constexpr ByEnum<LayerFormat, FileFormat, 4> file_formats{
    {{{"geopackage", "GPKG"}, {"shapefile", "ESRI Shapefile"}, {"flatgeobuf", "FlatGeobuf"}, {"geojson", "GeoJSON"}}}};

void require_code(OGRSpatialReference const* reference, std::string const& what) {
    if (reference == nullptr || reference->GetAuthorityCode(nullptr) == nullptr) {
        throw BadInput(what + ": GeoJSON takes coordinates without an EPSG code for degrees: bring the network into a "
                              "CRS that has one, or write FlatGeobuf");
    }
}

/// A CRS that could not be written, such as the .prj of a shapefile, leaves only a file without one, and no error.
void require_crs(std::string const& path, OGRSpatialReference const& wanted, std::string const& what) {
    Dataset const written(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY));
    if (written == nullptr) {
        throw IoError(what + " could not be read back");
    }
    for (OGRLayer* const layer : written->GetLayers()) {
        OGRSpatialReference const* const found = layer->GetSpatialRef();
        bool const has_shape = layer->GetGeomType() != wkbNone;
        if (has_shape && (found == nullptr || found->IsProjected() != wanted.IsProjected() ||
                          found->IsGeographic() != wanted.IsGeographic())) {
            throw IoError(what + ": the CRS could not be written");
        }
    }
}

void write_file(std::vector<Table const*> const& tables, std::string const& crs, std::string const& path,
                LayerFormat format, Run const& run) {
    FileFormat const& file_format = file_formats[format];
    std::string const what = fmt::format("io.write_{}: {}", file_format.word, path);
    if (std::error_code ignored; std::filesystem::exists(path, ignored)) {
        throw IoError(what + " exists already");
    }
    Driver const driver;
    FixedDate const fixed_date;
    OGRSpatialReference reference;
    if (!crs.empty()) {
        reference = read_reference(crs);
    }
    OGRSpatialReference* const used = crs.empty() ? nullptr : &reference;
    if (format == LayerFormat::geojson) {
        require_code(used, what);
    }
    GDALDriver* const writer = GetGDALDriverManager()->GetDriverByName(file_format.driver);
    Dataset dataset(writer == nullptr ? nullptr : writer->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    if (dataset == nullptr) {
        driver.check(what);
        throw IoError(what + " could not be created");
    }
    LayerTarget const target{format, what, driver, *dataset, used};
    bool const transactions = format == LayerFormat::geopackage;
    if (transactions) {
        target.require(dataset->StartTransaction() == OGRERR_NONE);
    }
    for (Table const* const table : tables) {
        write_layer(target, *table, run);
    }
    if (transactions) {
        target.require(dataset->CommitTransaction() == OGRERR_NONE);
    }
    dataset.reset();
    driver.check(what);
    if (used != nullptr) {
        require_crs(path, *used, what);
        driver.check(what);
    }
}

} // namespace

void write_tables(std::vector<Table> const& tables, std::string const& crs, std::string const& path, Run const& run) {
    std::vector<Table const*> all;
    for (Table const& table : tables) {
        all.push_back(&table);
    }
    write_file(all, crs, path, LayerFormat::geopackage, run);
}

void write_shapefile(Table const& table, std::string const& crs, std::string const& path, Run const& run) {
    write_file({&table}, crs, path, LayerFormat::shapefile, run);
}

void write_flatgeobuf(Table const& table, std::string const& crs, std::string const& path, Run const& run) {
    write_file({&table}, crs, path, LayerFormat::flatgeobuf, run);
}

void write_geojson(Table const& table, std::string const& crs, std::string const& path, Run const& run) {
    write_file({&table}, crs, path, LayerFormat::geojson, run);
}

} // namespace thalweg::io
