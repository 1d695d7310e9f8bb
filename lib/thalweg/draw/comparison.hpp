// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <thalweg/core/raster.hpp>
#include <thalweg/draw/picture.hpp>

namespace thalweg::draw {

/// A terrain and the DEM that it is compared with, on one grid.
struct ComparisonSheet {
    Raster<std::uint8_t> const& shade_of_dem; ///< [1, 255] hillshade; 0: no data
    Raster<std::uint8_t> const& shade;        ///< likewise of the terrain
    Raster<float> const& difference;          ///< [m] terrain minus DEM; NaN: not known
    Mask const& divides_of_dem;
    Mask const& divides; ///< of the terrain
    /// [m] as limit_of_differences(), of the rasters that these are means of; none: of difference
    std::optional<double> limit_m = {};
};

/// Options of differences() and comparison().
struct ComparisonParams {
    std::string title;   ///< UTF-8; "" for none
    std::string dem;     ///< UTF-8, the name of the DEM
    int width_px = 2400; ///< [200, 8000]; the height follows
    Format format = Format::png;
};

/// The difference [m] at which the colours of differences end: the 98th percentile of its absolute values, rounded up
/// to 1, 2 or 5 times a power of ten; 1 where nothing differs.
double limit_of_differences(Raster<float> const& difference);

/// Draws the map of differences alone, without a margin: blue, the terrain is lower; red, it is higher; black, divides
/// of both; amber, of the DEM; violet, of the terrain.
/// \param sheet rasters on one grid
/// \param params title and dem are not used
/// \return one pixel or less a cell where the grid is wider than width_px
/// \throws BadInput when the rasters differ in size or have no cells
Picture differences(ComparisonSheet const& sheet, ComparisonParams const& params = {});

/// \param params width of a comparison
/// \return columns of pixels that each of its maps has: more cells in a row are not seen
std::int64_t columns_of_comparison(ComparisonParams const& params = {});

/// Draws hillshades of the DEM and the terrain and the map of differences beside one another, with a legend.
/// \throws BadInput as differences()
Picture comparison(ComparisonSheet const& sheet, ComparisonParams const& params = {});

} // namespace thalweg::draw
