// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run.hpp>

namespace thalweg::io {

/// Writes heights as Float32 tiled COG, DEFLATE, nodata -9999 for NaN. The same bytes for the same raster.
void write_dem(Raster<float> const& dem, std::string const& path, Run const& run = {});

/// Writes a Byte GeoTIFF (tiled, DEFLATE).
void write_mask(Mask const& mask, std::string const& path, Run const& run = {});

/// Reads one band of any GDAL raster; no-data becomes NaN. crs may be geographic or "" here; cell_m is in its unit.
/// Throws: BadInput: not a raster, cells not square (say which sizes), rotated, larger than memory; IoError.
Raster<float> read_dem(std::string const& path, Run const& run = {});

/// GDAL's hillshade (multidirectional where asked), 1..255; 0 where there is no data.
Raster<std::uint8_t> hillshade(Raster<float> const& dem, double z_factor = 1.0);

struct ContourLine {
    double z = 0.0; ///< [m]
    std::vector<Vec2> line;
};

/// GDAL's contour lines at multiples of an interval [m].
std::vector<ContourLine> contours(Raster<float> const& dem, double interval_m, Run const& run = {});

/// Writes contours as a GeoPackage, layer contours (LineStringZ; z real, is_index integer: every fifth).
void write_contours(std::vector<ContourLine> const& lines, double interval_m, std::string const& crs,
                    std::string const& path, Run const& run = {});

} // namespace thalweg::io
