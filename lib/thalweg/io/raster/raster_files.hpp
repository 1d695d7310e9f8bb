// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <thalweg/core/height_unit.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::io {

/// The quantity in the cells of a raster.
enum class CellValues : std::uint8_t {
    heights, ///< of terrain
    numbers  ///< of a mask, of classes, factors
};

/// Options of read_dem().
struct ReadDemParams {
    /// A stored value that is no-data, besides those that the file declares; NaN: none. If set, undeclared no-data is
    /// not searched.
    std::optional<double> nodata = {};
    CellValues values = CellValues::heights;
};

/// Reads the only band of any GDAL raster file, with scale and offset applied, in metres according to the unit of the
/// band or the vertical part of its CRS (metres if neither names one). No-data and masked cells become NaN; cells that
/// are NaN in the file are counted in the log. crs may be geographic or "" here; cell_m is in its unit. A raster
/// without a position has cells of 1 and its south-west corner at 0.
/// \param path of the file
/// \return heights; NaN: no data
/// \throws BadInput for a missing file, one that is not a raster, more than one band, cells that are not square (sides
/// differ by more than 0.1 %, or over the raster by a tenth of a cell; names both sizes), a raster that is rotated,
/// south-up or larger than memory, no heights at all, a height beyond 1e30 (a damaged tile), or undeclared no-data:
/// values -9999, -32767, -32768, -99999; if the file declares none and the cells are heights, also the lowest or
/// highest value if it is not 0, fills 3 x 3 cells and is farther from the next value than the others are apart
Raster<float> read_dem(std::string const& path, ReadDemParams const& params, Run const& run = {});

/// Reads a DEM with default options.
/// \param path of the file
/// \return as with options
Raster<float> read_dem(std::string const& path, Run const& run = {});

/// Reads a DEM in the file's unit: values that differ in the file differ here.
/// \param path of the file
/// \return as read_dem
Raster<float> read_stored_dem(std::string const& path, ReadDemParams const& params = {}, Run const& run = {});

/// Tells whether read_dem accepts a raster's cells as squares.
/// \param path of the file
/// \return true also for a raster without a position, or one that is rotated or south-up
/// \throws BadInput for a missing file or one that is not a raster
bool has_square_cells(std::string const& path);

/// Reads a mask: the cells of a raster file whose value is neither 0 nor no-data.
/// \param path of the file
/// \param grid the file's cells must be those of this grid
/// \return 1: marked
/// \throws BadInput as read_dem; and, naming both, when the file has other cells or another CRS than the grid, or only
/// one of them has a CRS
Mask read_mask(std::string const& path, Grid const& grid, Run const& run = {});

/// Warps a DEM to the coordinates and the cell size of a grid.
/// \param dem [m] by cell; NaN: no data
/// \param grid the target's lattice of cells
/// \param what "io.warp_to_grid: source.tif", for messages
/// \return unchanged if CRS and cell size are the grid's; else warped (bilinear, means if cells become larger) to the
/// lattice that extends the grid's cells; NaN: no data
/// \throws BadInput naming both when only one of them has a CRS; when the DEM cannot be warped or becomes larger than
/// memory
Raster<float> warp_to_grid(Raster<float> const& dem, Grid const& grid, std::string const& what, Run const& run = {});

/// Writes heights as a new cloud-optimised GeoTIFF: Float32, tiles of 512, DEFLATE with the floating-point predictor,
/// nodata -9999 for NaN, overviews by mean. The same bytes for the same raster and any number of threads.
/// \param dem [m] by cell; NaN: no data
/// \param path of the file
/// \throws BadInput for an infinite height or one of -9999 m, or when grid.crs is not a CRS
void write_dem(Raster<float> const& dem, std::string const& path, Run const& run = {});

/// Writes heights that are already in a unit, which the band names: "m" or "ft".
/// \param dem in the unit, by cell; NaN: no data
/// \param path of the file
/// \param unit of heights
void write_dem(Raster<float> const& dem, std::string const& path, HeightUnit unit, Run const& run = {});

/// Writes a new Byte GeoTIFF (tiled, DEFLATE), reproducible as by write_dem.
/// \param mask by cell
/// \param path of the file
/// \throws Error as write_dem
void write_mask(Mask const& mask, std::string const& path, Run const& run = {});

inline constexpr std::uint8_t no_code = 255; ///< nodata value of codes

/// Writes codes by cell as a new Byte GeoTIFF (tiled, DEFLATE), nodata no_code, reproducible as by write_dem.
/// \param codes by cell
/// \param path of the file
/// \throws Error as write_dem
void write_codes(Raster<std::uint8_t> const& codes, std::string const& path, Run const& run = {});

/// Writes numbers by cell as a new Float64 GeoTIFF (tiled, DEFLATE with the floating-point predictor), nodata -9999 for
/// NaN, reproducible as by write_dem: contributing areas, which Float32 would round.
/// \param field by cell
/// \param path of the file
/// \throws Error as write_dem
void write_field(Raster<double> const& field, std::string const& path, Run const& run = {});

} // namespace thalweg::io
