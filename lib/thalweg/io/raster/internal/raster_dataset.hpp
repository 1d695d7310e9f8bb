// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/raster.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>

namespace thalweg::io {

// Rasters as data sets of GDAL.

/// Sets position and CRS of a data set.
/// \throws BadInput when the CRS is invalid
void set_frame(GDALDataset& dataset, Grid const& grid);

/// \throws BadInput when a raster is empty or has too many cells for GDAL.
void require_size(Grid const& grid, std::string const& what);

/// Copies heights to a GDAL data set, with nodata_height for NaN.
/// \throws BadInput when a height is infinite or equals nodata_height, or as require_size
Dataset in_memory(Raster<float> const& dem, std::string const& what);

} // namespace thalweg::io
