// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::io {

/// Which metres are taken as such.
enum class MetresOf : std::uint8_t {
    the_ground, ///< those of a CRS whose lengths are off by 1 % at most
    any_crs     ///< those of every CRS that is projected in metres
};

/// Options of read_drawable().
struct ReadDrawableParams {
    std::int64_t most_side = 4000;          ///< [16, 30000] cells
    MetresOf metres = MetresOf::the_ground; ///< what counts as metres
    std::optional<double> nodata = {};      ///< as in ReadDemParams
};

/// A DEM in a form that can be drawn, and in words what was done to it.
struct Drawable {
    Raster<float> dem;
    std::vector<std::string> notes;
};

/// Reads any raster of heights for pictures, where read_dem would refuse: larger than most_side cells a side becomes
/// means of k x k cells (what fills no block at the east and south edge is left out); a CRS that is geographic or not
/// in metres, or whose lengths are off by more than 1 % (Web Mercator), is warped (bilinear) into the UTM zone of
/// its centre, or, wider than 12 degrees or near a pole, into an equal-area projection centred on it; cells that are no
/// squares, rotated or south-up are made north-up squares; of several bands the first is taken; without a CRS
/// coordinates count as metres.
/// \param path path of the file
/// \return notes, one for each such change; no-data and masked cells as NaN, scale and offset applied.
/// \throws BadInput no such file, not a raster, complex numbers, no heights at all, a height beyond 1e30, undeclared
/// no-data as in read_dem, a place without projection, params.nodata beside another value that the file declares
Drawable read_drawable(std::string const& path, ReadDrawableParams const& params = {}, Run const& run = {});

} // namespace thalweg::io
