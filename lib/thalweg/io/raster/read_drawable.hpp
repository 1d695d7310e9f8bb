// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/io/gdal/access.hpp>
#include <thalweg/io/raster/raster_files.hpp>

namespace thalweg::io {

/// Which metres are accepted.
enum class MetresOf : std::uint8_t {
    the_ground, ///< of a CRS whose lengths are wrong by at most 1 %
    any_crs     ///< of every CRS projected in metres
};

/// Options of read_drawable().
struct ReadDrawableParams {
    std::int64_t most_side = 4000;          ///< [16, 1000000] cells
    MetresOf metres = MetresOf::the_ground; ///< what counts as metres
    ReadDemParams reading = {};
    bool summarises = false; ///< gives Drawable::own
};

/// The heights of a file's own cells, in degrees each weighted by its area on the ellipsoid.
struct OwnHeights {
    std::int64_t cells = 0; ///< cells with data
    std::int64_t nodata = 0;
    double mean = 0.0; ///< [m]
    double std = 0.0;  ///< [m] population standard deviation
    double min = 0.0;  ///< [m]
    double max = 0.0;  ///< [m]
    // NaN on a plain.
    double skew = 0.0;     ///< [-] population
    double kurtosis = 0.0; ///< [-] population excess kurtosis
};

/// A DEM in metres, with findings on its conversion.
struct Drawable {
    Raster<float> dem;
    std::vector<Finding> findings;
    std::optional<OwnHeights> own; ///< if asked for, and dem has other cells than the file
};

/// Reads any raster of heights as squares in metres, even if read_dem would refuse it: one larger than most_side cells
/// a side is reduced to means of k x k cells (incomplete blocks at the east and south are dropped); one in a CRS that
/// is geographic or not in metres, or whose lengths are wrong by more than 1 % (Web Mercator), is warped (bilinear) to
/// the UTM zone of its centre, or, if wider than 12 degrees, near a pole or not on the Earth, to an equal-area
/// projection centred on it; cells that are not square or rotated become north-up squares; without a CRS coordinates
/// count as metres. Values are those of read_dem_file.
/// \param file the file
/// \return with one finding per change; NaN: no data
/// \throws BadInput as read_dem_file, but for the shape of cells; for a position without a projection
Drawable read_drawable(Source const& file, ReadDrawableParams const& params = {}, Run const& run = {});

} // namespace thalweg::io
