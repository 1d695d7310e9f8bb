// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include <thalweg/core/run/run.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/network/table.hpp>

class GDALDataset;
class OGRSpatialReference;

namespace thalweg::io {

// How a table becomes a layer of what GDAL has opened.

enum class LayerFormat : std::uint8_t { geopackage, shapefile, flatgeobuf, geojson, postgresql };

struct LayerTarget {
    LayerFormat format;
    std::string what; ///< "io.write_geopackage: PATH", begins every message
    Driver const& driver;
    GDALDataset& dataset;
    OGRSpatialReference* reference; ///< null for none
    std::string db_schema = {};     ///< of a database, where the layer comes to be; "" for its default

    /// Throws IoError, with GDAL's words where it has some.
    void require(bool done) const;
};

/// Writes a table as a new layer. Throws: BadInput naming table, row and column when a number is not finite or does not
/// fit its column; IoError; Cancelled.
void write_layer(LayerTarget const& target, Table const& table, Run const& run);

/// Keeps the formats that stamp the day of writing from doing so, for the calling thread, while it lives.
class FixedDate {
public:
    FixedDate();
    ~FixedDate();
    FixedDate(FixedDate const&) = delete;
    FixedDate& operator=(FixedDate const&) = delete;
};

// Decimals in a shapefile: more than a double at 1e6 m carries, few enough for 1e13 m or 1e16 m2.
inline constexpr int length_decimals = 9;
inline constexpr int area_decimals = 6;
inline constexpr int slope_decimals = 15;

} // namespace thalweg::io
