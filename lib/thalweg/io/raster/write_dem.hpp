// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include <thalweg/core/height_unit.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::io {

/// Writes heights as a new cloud-optimised GeoTIFF: Float32, tiles of 512, DEFLATE with the floating-point predictor,
/// nodata -9999 for NaN, overviews by mean.
/// \post the same bytes for the same raster and any number of threads.
/// \param dem [m] heights by cell; NaN: no data
/// \param path path of the file
/// \param run progress, log, stop token and number of threads
/// \throws BadInput at an infinite height or one of -9999 m, or when grid.crs is not a CRS
/// \throws IoError
/// \throws Cancelled
void write_dem(Raster<float> const& dem, std::string const& path, Run const& run = {});

/// The same, of heights that are in a unit already: the band names it, "m" or "ft". The other names "m".
/// \param dem [m] heights by cell; NaN: no data
/// \param path path of the file
/// \param unit the unit
/// \param run progress, log, stop token and number of threads
void write_dem(Raster<float> const& dem, std::string const& path, HeightUnit unit, Run const& run = {});

/// Writes a new Byte GeoTIFF (tiled, DEFLATE).
/// \post like write_dem.
/// \param mask the mask
/// \param path path of the file
/// \param run progress, log, stop token and number of threads
/// \throws Error like write_dem
void write_mask(Mask const& mask, std::string const& path, Run const& run = {});

inline constexpr std::uint8_t no_code = 255; ///< nodata of codes

/// Writes codes by cell as a new Byte GeoTIFF (tiled, DEFLATE), nodata no_code.
/// \post like write_dem.
/// \param codes codes by cell
/// \param path path of the file
/// \param run progress, log, stop token and number of threads
/// \throws Error like write_dem
void write_codes(Raster<std::uint8_t> const& codes, std::string const& path, Run const& run = {});

/// Writes numbers by cell as a new Float64 GeoTIFF (tiled, DEFLATE with the floating-point predictor), nodata -9999 for
/// NaN: contributing areas, which Float32 would round.
/// \post like write_dem.
/// \param field numbers by cell
/// \param path path of the file
/// \param run progress, log, stop token and number of threads
/// \throws Error like write_dem
void write_field(Raster<double> const& field, std::string const& path, Run const& run = {});

} // namespace thalweg::io
