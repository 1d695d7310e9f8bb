// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/channels.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>
#include <thalweg/surface/equilibrium/internal/level.hpp>
#include <thalweg/surface/equilibrium/internal/start_level.hpp>

// Terrain around the caller's grid. See docs/algorithms/equilibrium_levels.md.

namespace thalweg::surface {

/// Chooses the region; none if the terrain ends at the grid or the sea, rivers end inside, heights are prescribed, or
/// the grid is small.
Region region_around(Channels const& rivers, EquilibriumFields const& fields, EquilibriumParams const& params);

/// The extent of the region on its finest level.
LevelExtent extent_of(Region const& region, Grid const& grid);

/// Converts rivers of a window's level to the region's frame. Rivers that leave the window continue away from it, with
/// random bends, until they meet another or the region's border.
RiverCells rivers_of_region(RiverCells const& rivers, LevelExtent const& window, LevelExtent const& region,
                            std::int64_t side, std::uint64_t seed);

/// Relates the frame of a window's level and its terrain to the region.
struct RegionFrame {
    struct Cell {
        std::uint32_t cell;
        float z;     ///< of the region's valleys
        float share; ///< [0, 2] of the height of terrain above those valleys: 0 where a valley leaves, 1 on average
    };
    struct Sample {
        std::uint32_t cell;
        float z; ///< of the region's valleys
    };
    std::vector<Cell> cells;
    std::vector<Sample> land; ///< samples well inside
};

/// Sets the boundary conditions of a window's level from the region. The frame is closed where water flows in, which
/// enters at the lowest cell beside it, and open elsewhere.
RegionFrame frame_by_region(TerrainLevel& level, TerrainLevel const& region, std::uint64_t seed);

/// Sets the heights of an open frame: the region's, plus the excess of the terrain inside over the region, whose cells
/// resolve no hillslopes.
void lift_frame(TerrainLevel& level, RegionFrame const& frame);

/// By river cell of a window's level that ends at the frame: the height of the region there.
std::vector<float> end_heights(TerrainLevel const& level, TerrainLevel const& region);

/// Lists where 1000 cells or more drain into the caller's grid, margin cells inside the finest level's frame.
std::vector<RegionInflow> inflows_of(TerrainLevel const& level, Grid const& grid, std::int64_t margin);

} // namespace thalweg::surface
