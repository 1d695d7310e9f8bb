// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/grid.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>
#include <thalweg/surface/equilibrium/internal/land_level.hpp>

/// Private to this module.
namespace thalweg::surface {

/// How the frame of a window's level and the land in it stand to the region.
struct RegionFrame {
    struct Cell {
        std::uint32_t cell;
        float z;     ///< of the region's valleys
        float share; ///< [0, 2] of the height of land over those valleys: 0 where a valley leaves, 1 in the mean
    };
    struct Sample {
        std::uint32_t cell;
        float z; ///< of the region's valleys
    };
    std::vector<Cell> cells;
    std::vector<Sample> land; ///< well inside
};

/// Sets what lies around a window's level as the region has it. The frame is closed where water flows in, which is
/// given to the lowest cell beside it, and is open elsewhere.
RegionFrame frame_by_region(LandLevel& level, LandLevel const& region, std::uint64_t seed);

/// Sets the heights of an open frame: the region's, and as much as land inside stands higher than the region, whose
/// cells know no hillslopes.
void lift_frame(LandLevel& level, RegionFrame const& frame);

/// By river cell of a window's level the height of the region there, of those that end at the frame.
std::vector<float> end_heights(LandLevel const& level, LandLevel const& region);

/// Where 1000 cells or more drain into the caller's grid, margin cells inside the finest level's frame.
std::vector<RegionInflow> inflows_of(LandLevel const& level, Grid const& grid, std::int64_t margin);

} // namespace thalweg::surface
