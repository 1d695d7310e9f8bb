// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/height_unit.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/io/gdal/access.hpp>

namespace thalweg::io {

/// The quantity in the cells of a raster.
enum class CellValues : std::uint8_t {
    heights, ///< of terrain
    numbers, ///< factors: scale and offset are applied
    codes    ///< of a mask, of classes: as they are stored
};

/// How a picture's colours stand for heights.
enum class HeightEncoding : std::uint8_t {
    none,        ///< they do not
    terrain_rgb, ///< -10000 m + 0.1 m (65536 red + 256 green + blue)
    terrarium    ///< 256 m red + 1 m green + 1/256 m blue - 32768 m
};

/// Options of read_dem().
struct ReadDemParams {
    /// [as stored] A value that is no-data, besides those that the file declares; NaN: none. If set, undeclared no-data
    /// is not searched.
    std::optional<double> nodata = {};
    CellValues values = CellValues::heights;
    /// The band or variable with the heights, by number from 1 or by name; "": the only one, or the only one whose name
    /// means heights.
    std::string band = {};
    HeightEncoding encoding = HeightEncoding::none;
    // Of a heightmap without a description: .r16, .r32, .raw, OpenEXR.
    std::int64_t raw_width = 0; ///< samples of a row, set together with raw_height; 0: as many as of a column
    std::int64_t raw_height = 0;
    std::optional<double> raw_cell_m = {};                     ///< [m] > 0 between samples; nothing: 1
    std::optional<std::pair<double, double>> raw_heights = {}; ///< [m] of 0 and 65535; nothing: numbers are metres

    friend bool operator==(ReadDemParams const&, ReadDemParams const&) = default;
};

/// A DEM as it was read.
struct DemFile {
    Raster<float> dem;
    std::vector<Finding> findings; ///< what was done, and doubts
};

/// Reads the heights of any GDAL raster file, or of a heightmap (write_heightmap()), in metres: scale and offset are
/// applied, then the unit that the band or the vertical part of its CRS names (metres where none is named); depths that
/// grow downwards change their sign; the heights' datum stays, and the CRS of the result is the horizontal part.
/// No-data, masked and transparent cells become NaN, and so do cells that are NaN themselves, with a finding. Rows from
/// south to north, columns from east to west, and rows that are columns of the map, are read the other way. crs may be
/// geographic or "" here; cell_m is in its unit. A raster without position has cells of 1 and its south-west corner at
/// 0; one in a site's own system has metres and no CRS.
/// \param source the file, or GDAL's name of one of its variables
/// \return the raster, with findings
/// \throws BadInput no such file, not a raster, several bands or variables of which none is clearly that of heights, a
/// picture in colours, cells not square (their sides differ by more than 0.1 %, or over the raster by a tenth of a
/// cell; says which sizes), rotated, larger than memory, longitudes and latitudes without a CRS, latitudes beyond a
/// pole, a geocentric CRS, no heights at all, a height beyond 1e30 (a damaged tile), values that no terrain has and the
/// file does not declare as no-data: -9999, -32767, -32768, -99999, 1.18e-38, of heights also 32767 m and 65535 m;
/// where it declares none and the cells are heights, also the lowest or highest value when it fills 3 x 3 cells and
/// lies farther from the next one than the others are apart (of 0: more than 300 m)
DemFile read_dem_file(Source const& source, ReadDemParams const& params = {}, Run const& run = {});

/// \param source the file
/// \return the raster of read_dem_file()
Raster<float> read_dem(Source const& source, ReadDemParams const& params, Run const& run = {});

/// \param source the file
/// \return the same with default options
Raster<float> read_dem(Source const& source, Run const& run = {});

/// \param source the file
/// \return the same, with heights in the file's unit, which grow upwards: two that differ there differ here.
Raster<float> read_stored_dem(Source const& source, ReadDemParams const& params = {}, Run const& run = {});

/// Reads a mask: the cells of any raster file whose value is neither 0 nor no-data.
/// \pre a file whose cells are those of a grid.
/// \param source the file
/// \param grid the grid
/// \return a mask on that grid.
/// \throws BadInput like read_dem; when the file's cells are not the grid's, or only one of both has a CRS, or their
/// CRS differ, naming both
Mask read_mask(Source const& source, Grid const& grid, Run const& run = {});

/// Warps a DEM to the coordinates and the cell size of a grid.
/// \param dem [m] by cell; NaN: no data
/// \param grid the target's lattice of cells
/// \param what "source.tif", for messages
/// \return unchanged if CRS and cell size are the grid's; else warped (bilinear, means if cells become larger) to the
/// lattice that extends the grid's cells; NaN: no data
/// \throws BadInput naming both when only one of them has a CRS; when the DEM cannot be warped or becomes larger than
/// memory
Raster<float> warp_to_grid(Raster<float> const& dem, Grid const& grid, std::string const& what, Run const& run = {});

/// Finds the cells of a lattice that a DEM covers.
/// \param dem [m] by cell
/// \param lattice a grid, whose cells go on beyond its edges, in any CRS
/// \param what as in warp_to_grid
/// \return the smallest grid of such cells around the DEM
/// \throws BadInput when the DEM cannot be warped or becomes larger than memory
Grid grid_around(Raster<float> const& dem, Grid const& lattice, std::string const& what);

/// Resamples a DEM to the cells of a grid.
/// \param dem [m] by cell; NaN: no data
/// \param grid in any CRS
/// \param what as in warp_to_grid
/// \return bit for bit where the grid's cells are cells of the DEM; else warped (bilinear, means if cells become
/// larger); NaN: no data, or beyond the DEM
/// \throws BadInput naming both when only one of them has a CRS; when the DEM cannot be warped
Raster<float> resample(Raster<float> const& dem, Grid const& grid, std::string const& what, Run const& run = {});

/// Checks the name of a GeoTIFF that is to be written.
/// \param path ends in .tif or .tiff, or has no ending
/// \throws BadParameter for another ending
void require_geotiff_name(std::string const& path);

/// Writes heights as a new cloud-optimised GeoTIFF: Float32, tiles of 512, DEFLATE with the floating-point predictor,
/// nodata -9999 for NaN, overviews by mean. The same bytes for the same raster and any number of threads.
/// \param dem [m] by cell; NaN: no data
/// \param path of the file
/// \throws BadInput for an infinite height or one of -9999 m, or when grid.crs is not a CRS
/// \throws BadParameter as require_geotiff_name
void write_dem(Raster<float> const& dem, std::string const& path, Run const& run = {});

/// Writes heights that are already in a unit, which the band names: "m" or "ft".
/// \param dem in the unit, by cell; NaN: no data
/// \param path of the file
/// \param unit of heights
void write_dem(Raster<float> const& dem, std::string const& path, HeightUnit unit, Run const& run = {});

/// \internal
/// What a file of heights says of them.
struct DemLabel {
    HeightUnit unit = HeightUnit::metre;
    std::string remark = {}; ///< UTF-8: TIFF's ImageDescription; "": none
};

/// \internal
/// Writes heights that are already in a unit, with a remark.
/// \param dem in the unit, by cell; NaN: no data
/// \param path of the file
/// \throws Error as write_dem without a label
void write_dem(Raster<float> const& dem, std::string const& path, DemLabel const& label, Run const& run = {});

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
