// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include <thalweg/core/run/run.hpp>
#include <thalweg/io/files/internal/about.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/tables/table.hpp>

class GDALDataset;
class OGRSpatialReference;

namespace thalweg::io {

// How a table becomes a layer of what GDAL has opened.

enum class LayerFormat : std::uint8_t { geopackage, shapefile, flatgeobuf, geojson, geojson2008, postgresql };

struct LayerTarget {
    LayerFormat format;
    About about; ///< whose errors they are
    Driver const& driver;
    GDALDataset& dataset;
    OGRSpatialReference* reference; ///< null for none
    std::string db_schema = {};     ///< of a database, for the layer; "" for its default

    /// Throws IoError, with GDAL's words where it has some.
    void require(bool done) const;
};

/// Writes a table as a new layer.
/// \throws BadInput naming table, row and column when a number is not finite or does not fit its column; IoError;
/// Cancelled
void write_layer(LayerTarget const& target, Table const& table, Run const& run);

/// Writes tables with shapes as the layers of a new file: see write_tables. A shapefile's path ends in .shp, and it is
/// UTF-8. GeoJSON is in degrees (RFC 7946), rounded to 1e-9, about 0.1 mm; that of 2008 in its own coordinates, with
/// the CRS named.
/// \throws BadInput also when GeoJSON has no CRS, or that of 2008 one without EPSG code
void write_file(std::span<Table const> tables, std::string const& crs, std::string const& path, LayerFormat format,
                Run const& run);

/// Calls body for each row of a table, and run now and then.
template <class Body> void each_row(Table const& table, Run const& run, Body const& body) {
    constexpr std::size_t rows_between_reports = 1024;
    for (std::size_t row = 0; row < table.rows; ++row) {
        if (row % rows_between_reports == 0) {
            run.at(static_cast<double>(row) / static_cast<double>(table.rows), "write");
        }
        body(row);
    }
}

/// What formats stamp as the day of writing: a CPLConfigOptionSetter sets it for a thread.
inline constexpr char const* date_option = "OGR_CURRENT_DATE";
inline constexpr char const* fixed_date = "2000-01-01T00:00:00.000Z";

// Decimals in a shapefile: more than a double at 1e6 m carries, few enough for 1e13 m or 1e16 m2.
inline constexpr int length_decimals = 9;
inline constexpr int area_decimals = 6;
inline constexpr int slope_decimals = 15;

/// The table layer_styles of a GeoPackage, with a default style for each table that has one.
Table styles_table(std::span<Table const> tables);

} // namespace thalweg::io
