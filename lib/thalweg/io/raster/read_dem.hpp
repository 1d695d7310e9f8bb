// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::io {

/// What the cells of a raster hold.
enum class CellValues : std::uint8_t {
    heights, ///< of terrain
    numbers  ///< of a mask, of classes, factors
};

/// Options of read_dem().
struct ReadDemParams {
    /// A stored value that is no-data, beside what the file declares; NaN: none. With either, undeclared no-data is not
    /// searched.
    std::optional<double> nodata = {};
    CellValues values = CellValues::heights;
};

/// Reads the only band of any GDAL raster file, scale and offset applied, in metres by the unit that the band or the
/// vertical part of its CRS names (metres where none is named); no-data and masked cells become NaN; cells that are NaN
/// themselves are counted in the log. crs may be geographic or "" here; cell_m is in its unit. A raster without
/// position has cells of 1 and its south-west corner at 0.
/// \param path path of the file
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return the raster
/// \throws BadInput no such file, not a raster, more than one band, cells not square (their sides differ by more than
/// 0.1 %, or over the raster by a tenth of a cell; says which sizes), rotated or south-up, larger than memory, no
/// heights at all, a height beyond 1e30 (a damaged tile), values that no terrain has and the file does not declare as
/// no-data: -9999, -32767, -32768, -99999; where it declares none and the cells are heights, also the lowest or highest
/// value when it is not 0, fills 3 x 3 cells and lies farther from the next one than the others are apart
/// \throws IoError
/// \throws Cancelled
Raster<float> read_dem(std::string const& path, ReadDemParams const& params, Run const& run = {});

/// \param path path of the file
/// \param run progress, log, stop token and number of threads
/// \return the same with default options
Raster<float> read_dem(std::string const& path, Run const& run = {});

/// \param path path of the file
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return the same, with heights in the file's unit: two that differ there differ here.
Raster<float> read_stored_dem(std::string const& path, ReadDemParams const& params = {}, Run const& run = {});

/// \param path path of the file
/// \return whether read_dem takes a raster's cells as squares; true also of one that has no place, is rotated or is
/// south-up
/// \throws BadInput no such file or not a raster
bool has_square_cells(std::string const& path);

} // namespace thalweg::io
