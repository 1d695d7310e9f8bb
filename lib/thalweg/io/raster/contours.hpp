// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/height_unit.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::io {

struct ContourLine {
    double z = 0.0; ///< [m]
    std::vector<Vec2> line;
};

/// GDAL's contour lines at multiples of an interval [m].
/// Throws: BadParameter when the interval is not above 0 or gives more than 10000 levels; BadInput: an empty raster, an
/// infinite height; Cancelled.
std::vector<ContourLine> contours(Raster<float> const& dem, double interval_m, Run const& run = {});

/// Writes contours as a new GeoPackage, layer contours (LineStringZ; z real, is_index integer: 1 for every fifth).
/// Gives: the same bytes for the same lines. Throws: BadInput; IoError, also when the file exists; Cancelled.
void write_contours(std::vector<ContourLine> const& lines, double interval_m, std::string const& crs,
                    std::string const& path, Run const& run = {});

/// The same of heights in a unit; of feet there is a column z_unit besides.
void write_contours(std::vector<ContourLine> const& lines, double interval, std::string const& crs,
                    std::string const& path, HeightUnit unit, Run const& run = {});

} // namespace thalweg::io
