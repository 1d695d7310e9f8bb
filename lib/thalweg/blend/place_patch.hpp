// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>

#include <thalweg/blend/patch.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::blend {

/// A window of a source, from its north-west.
struct SourceWindow {
    std::int64_t col = 0;
    std::int64_t row = 0;
    std::int64_t width = 0;  ///< [cells] >= 1
    std::int64_t height = 0; ///< [cells] >= 1
};

/// Options of place_patch().
struct PlacePatchParams {
    std::optional<Vec2> at = {};             ///< [m] new position of the window's centre; empty: its own
    double rotate_deg = 0.0;                 ///< [deg] in [-360, 360], counterclockwise about the centre
    double scale = 1.0;                      ///< > 0, in plan
    double gain = 1.0;                       ///< finite, of heights
    std::optional<SourceWindow> window = {}; ///< the part of the source to place; empty: all
    Mask part = {};                          ///< on the target's grid: cells that may be replaced; empty: all
};

/// Resamples a DEM onto the grid of another: moved, rotated about the vertical, scaled.
/// \param source [m] by cell, of any cell size; NaN: no data; in the target's coordinates
/// \param target grid of the result
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return heights bilinear between cell centres, bit for bit at these (to 1e-6 of a cell); NaN where one is missing or
/// beyond the outline of centres with data. The mask holds the cells of `part` in the window that lie, with all
/// neighbours, inside the outline. The same bits for any number of threads.
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput when the window leaves the source, part is on another grid or empty, or the mask would be empty:
/// names both extents
/// \throws Cancelled
///
/// Source: \cite nenu2015, algorithm 1, step 1 and section 4.2 (rotation and scaling).
Patch place_patch(Raster<float> const& source, Grid const& target, PlacePatchParams const& params = {},
                  Run const& run = {});

} // namespace thalweg::blend
