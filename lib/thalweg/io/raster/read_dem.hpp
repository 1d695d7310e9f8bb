// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::io {

/// Reads the only band of any GDAL raster file, scale and offset applied, in metres by the unit that the band or the
/// vertical part of its CRS names (metres where none is named); no-data and masked cells become NaN. crs may be
/// geographic or "" here; cell_m is in its unit. A raster without position has cells of 1 and its south-west corner at
/// 0.
/// \param path path of the file
/// \param run progress, log, stop token and number of threads
/// \return the raster
/// \throws BadInput no such file, not a raster, more than one band, cells not square (says which sizes), rotated or
/// south-up, larger than memory, no heights at all, a height beyond 1e30 (a damaged tile)
/// \throws IoError
/// \throws Cancelled
Raster<float> read_dem(std::string const& path, Run const& run = {});

/// \param path path of the file
/// \param run progress, log, stop token and number of threads
/// \return the same, with heights in the file's unit: two that differ there differ here.
Raster<float> read_stored_dem(std::string const& path, Run const& run = {});

} // namespace thalweg::io
