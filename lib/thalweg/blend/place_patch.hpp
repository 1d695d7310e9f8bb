// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>

#include <thalweg/blend/patch.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::blend {

/// Cells of a source, from its north-west.
struct SourceWindow {
    std::int64_t col = 0;
    std::int64_t row = 0;
    std::int64_t width = 0;  ///< [cells] >= 1
    std::int64_t height = 0; ///< [cells] >= 1
};

/// Options of place_patch().
struct PlacePatchParams {
    std::optional<Vec2> at =
        {};                  ///< [m] of the target, where the window's centre comes to lie; its own place without it
    double rotate_deg = 0.0; ///< [deg] in [-360, 360], counterclockwise about the centre
    double scale = 1.0;      ///< > 0, in plan
    double gain = 1.0;       ///< finite, of heights
    std::optional<SourceWindow> window = {}; ///< the part of the source that is laid; all of it without
    Mask part = {};                          ///< on the target's grid: cells that may be replaced; all where empty
};

/// Lays a DEM on the grid of another: moved, turned about z, scaled.
/// \pre a source, NaN where it has no data, whose coordinates are the target's; its cells may have another size. Its
/// outline is that of its cells' centres, less those without data that reach the edge through others.
/// \param source the file or DEM to take from
/// \param target [m] the DEM that is changed; NaN: no data
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return heights bilinear between the centres of the source's cells, those of its own centres (to 1e-6 of a cell) as
/// they stand; NaN beyond the outline and where one of the centres it lies between has no data. The mask holds the
/// cells of part that lie in the window and, like all their neighbours, within the outline. The same bits for any
/// number of threads.
/// \throws BadParameter
/// \throws BadInput when the window leaves the source, part is on another grid or empty, or the mask would be empty: it
/// names both places
/// \throws Cancelled
///
/// Source: \cite nenu2015, algorithm 1, step 1 and section 4.2 (rotation and scaling).
Patch place_patch(Raster<float> const& source, Grid const& target, PlacePatchParams const& params = {},
                  Run const& run = {});

} // namespace thalweg::blend
