// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace thalweg::pipeline {

/// What becomes of rivers under a patch.
enum class PatchRivers : std::uint8_t { keep, replace };

/// Real relief pasted into the land.
struct PatchRecipe {
    std::string source = {}; ///< DEM
    std::optional<std::array<double, 2>> at =
        {}; ///< [m] where its centre comes to lie; none: where it is, or the middle
    std::optional<std::array<double, 4>> window = {}; ///< [cells] of the source: column, row, width, height
    std::string mask = {};      ///< polygons, or a raster on the grid: what is pasted; "": all that is covered
    double rotate_deg = 0.0;    ///< [degrees] counterclockwise
    double scale = 1.0;         ///< > 0, in plan
    double gain = 1.0;          ///< of its heights
    double feather_cells = 0.0; ///< [cells] over which its slopes take over from the land's
    PatchRivers rivers = PatchRivers::keep;
};

} // namespace thalweg::pipeline
