// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/height_unit.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::io {

enum class Light { north_west, multidirectional };

/// Computes GDAL's hillshade.
/// \param dem [m] by cell; NaN: no data
/// \param z_factor > 0, vertical exaggeration
/// \param light direction of the light
/// \return 1 to 255; 0: no data
/// \throws BadInput for an empty raster or an infinite height
Raster<std::uint8_t> hillshade(Raster<float> const& dem, double z_factor = 1.0, Light light = Light::north_west);

/// A contour line.
struct ContourLine {
    double z = 0.0; ///< [m]
    std::vector<Vec2> line;
};

/// Computes GDAL's contour lines at multiples of an interval, simplified within a tenth of a cell; rings stay
/// rings, and are left out where they lie within a tenth of a cell.
/// \param dem [m] by cell; NaN: no data
/// \param interval_m [m] > 0
/// \return in GDAL's order
/// \throws BadParameter when the interval is not above 0 or gives more than 10000 levels
/// \throws BadInput for an empty raster or an infinite height
std::vector<ContourLine> contours(Raster<float> const& dem, double interval_m, Run const& run = {});

/// Writes contours as a new GeoPackage, layer contours (LineStringZ; z real, is_index integer: 1 for every fifth). The
/// same bytes for the same lines.
/// \param lines contours
/// \param interval_m [m] > 0, interval between contours
/// \param crs "EPSG:n" or WKT; "": none
/// \param path of the file
/// \throws IoError also when the file exists
void write_contours(std::vector<ContourLine> const& lines, double interval_m, std::string const& crs,
                    std::string const& path, Run const& run = {});

/// Writes contours with heights in a unit; for feet there is an additional column z_unit.
/// \param lines contours
/// \param interval [unit] > 0, interval between contours
/// \param crs "EPSG:n" or WKT; "": none
/// \param path of the file
/// \param unit of heights
void write_contours(std::vector<ContourLine> const& lines, double interval, std::string const& crs,
                    std::string const& path, HeightUnit unit, Run const& run = {});

} // namespace thalweg::io
