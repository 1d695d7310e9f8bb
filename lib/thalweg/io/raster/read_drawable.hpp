// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::io {

/// Which metres are accepted.
enum class MetresOf : std::uint8_t {
    the_ground, ///< of a CRS whose lengths are wrong by at most 1 %
    any_crs     ///< of every CRS projected in metres
};

/// Options of read_drawable().
struct ReadDrawableParams {
    std::int64_t most_side = 4000;          ///< [16, 30000] cells
    MetresOf metres = MetresOf::the_ground; ///< what counts as metres
    std::optional<double> nodata = {};      ///< as in ReadDemParams
};

/// A DEM that can be drawn, with findings on its conversion.
struct Drawable {
    Raster<float> dem;
    std::vector<Finding> findings;
};

/// Reads any raster of heights for pictures, even if read_dem would reject it: one larger than most_side cells a side
/// is reduced to means of k x k cells (incomplete blocks at the east and south are dropped); one in a CRS that is
/// geographic or not in metres, or whose lengths are wrong by more than 1 % (Web Mercator), is warped (bilinear) to the
/// UTM zone of its centre, or, if wider than 12 degrees or near a pole, to an equal-area projection centred on it;
/// cells that are not square, rotated or south-up become north-up squares; of several bands the first is used; without
/// a CRS coordinates count as metres.
/// \param path of the file
/// \return with one finding per change; NaN: no-data and masked cells; scale and offset are applied
/// \throws BadInput for a missing file, one that is not a raster, complex numbers, no heights at all, a height beyond
/// 1e30, undeclared no-data as in read_dem, a position without a projection, or params.nodata if the file declares
/// another value
Drawable read_drawable(std::string const& path, ReadDrawableParams const& params = {}, Run const& run = {});

} // namespace thalweg::io
