// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/surface/equilibrium/equilibrium.hpp>
#include <thalweg/surface/equilibrium/internal/land_level.hpp>

/// Private to this module.
namespace thalweg::surface {

/// The land of which the caller's grid is a window. Coarse levels are solved on all of it.
struct Region {
    std::size_t level = 0;   ///< number of the finest level that is; 0: there is no region
    std::int64_t margin = 0; ///< [finest cells] beyond the grid on each side, whole cells of that level
};

/// None where the land ends at the grid or the sea, rivers end inside, heights are given, or the grid is small.
Region region_around(Channels const& rivers, EquilibriumFields const& fields, EquilibriumParams const& params);

/// A level without its frame.
struct LevelExtent {
    std::int64_t width = 0;
    std::int64_t height = 0;
    Cell corner; ///< as LandLevel
};

/// The extent of the region on its finest level.
LevelExtent extent_of(Region const& region, Grid const& grid);

/// Rivers of a window's level in the frame of the region's. Those that leave the window go on, away from it, with
/// chance in their ways, until they meet another or the region's border.
RiverCells rivers_of_region(RiverCells const& rivers, LevelExtent const& window, LevelExtent const& region,
                            std::int64_t side, std::uint64_t seed);

} // namespace thalweg::surface
