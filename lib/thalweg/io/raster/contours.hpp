// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/height_unit.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::io {

/// A contour line.
struct ContourLine {
    double z = 0.0; ///< [m]
    std::vector<Vec2> line;
};

/// GDAL's contour lines at multiples of an interval [m].
/// \param dem [m] heights by cell; NaN: no data
/// \param interval_m [m] > 0, interval between contours
/// \param run progress, log, stop token and number of threads
/// \return the lines
/// \throws BadParameter when the interval is not above 0 or gives more than 10000 levels
/// \throws BadInput an empty raster, an infinite height
/// \throws Cancelled
std::vector<ContourLine> contours(Raster<float> const& dem, double interval_m, Run const& run = {});

/// Writes contours as a new GeoPackage, layer contours (LineStringZ; z real, is_index integer: 1 for every fifth).
/// \post the same bytes for the same lines.
/// \param lines the polylines
/// \param interval_m [m] > 0, interval between contours
/// \param crs "EPSG:n" or WKT; "": none
/// \param path path of the file
/// \param run progress, log, stop token and number of threads
/// \throws BadInput
/// \throws IoError also when the file exists
/// \throws Cancelled
void write_contours(std::vector<ContourLine> const& lines, double interval_m, std::string const& crs,
                    std::string const& path, Run const& run = {});

/// The same of heights in a unit; of feet there is a column z_unit besides.
/// \param lines the polylines
/// \param interval > 0, interval between contours, in the unit
/// \param crs "EPSG:n" or WKT; "": none
/// \param path path of the file
/// \param unit the unit
/// \param run progress, log, stop token and number of threads
void write_contours(std::vector<ContourLine> const& lines, double interval, std::string const& crs,
                    std::string const& path, HeightUnit unit, Run const& run = {});

} // namespace thalweg::io
