// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include <thalweg/core/raster.hpp>
#include <thalweg/io/files/internal/about.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/gdal/internal/rows_dataset.hpp>

namespace thalweg::io {

// Rasters as data sets of GDAL.

/// Sets position and CRS of a data set.
/// \throws BadInput when the CRS is invalid
void set_frame(GDALDataset& dataset, Grid const& grid);

/// \throws BadInput when a raster is empty or has too many cells for GDAL.
void require_size(Grid const& grid, About const& about);

/// Shows rows to GDAL as a data set with a grid's frame: see rows_dataset().
Dataset dataset_of(Grid const& grid, float no_data, RowPart<float> part);
Dataset dataset_of(Grid const& grid, std::int32_t no_data, RowPart<std::int32_t> part);

/// Shows heights to GDAL as a data set, with nodata_height for NaN.
/// \param dem outlives the data set
/// \throws BadInput when a height is infinite or equals nodata_height, or as require_size
Dataset dataset_of(Raster<float> const& dem, About const& about);

} // namespace thalweg::io
