// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/channels.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>
#include <thalweg/surface/equilibrium/internal/level.hpp>

// From the solver's heights to metres. See docs/algorithms/equilibrium_levels.md.

namespace thalweg::surface {

/// [m] The next height of a river from cell to cell where a lake's level leaves no more: an eighth of a millimetre.
inline float least_above(float z) {
    return std::max(z + 0x1p-13F, std::nextafter(z, std::numeric_limits<float>::infinity()));
}
inline float least_below(float z) {
    return std::min(z - 0x1p-13F, std::nextafter(z, -std::numeric_limits<float>::infinity()));
}

/// The ratio of the terrain's relief or mean slope to its target when heights in cells are multiplied by a factor; 1:
/// reached.
double share_of_target(Raster<float> const& land, double factor, EquilibriumParams const& params, Run const& run);

/// The caller's grid within the finest level.
struct Window {
    Grid const& grid;
    Mask const& land;    ///< without cells: all
    std::int64_t margin; ///< [cells] without the frame
};

/// Conversion from the solver's heights to metres: base_m + metres * z.
struct HeightConversion {
    double metres;
    double base_m;
    double mean_tangent; ///< mean slope of the terrain in metres
};

/// Extracts the caller's grid from terrain around known heights of rivers. Land two cells from a river is raised to it,
/// less the mean slope; walled: numbers of the river cells that stand higher above such land, banks aside.
EquilibriumTerrain extract_rebuilt(TerrainLevel level, Channels const& rivers, Window const& window,
                                   HeightConversion const& raise, Run const& run);

/// Chooses the conversion that gives the terrain in a window the target relief or mean slope, with the lowest river end
/// at 0.
HeightConversion height_conversion_for(TerrainLevel const& level, Channels const& rivers, Window const& window,
                                       EquilibriumParams const& params, Run const& run);

/// The ratio of the relief or mean slope in a window to its target, for this number of metres per unit.
double share_of_target(TerrainLevel const& level, Window const& window, double metres, EquilibriumParams const& params,
                       Run const& run);

/// The lowest height at which a river ends on the caller's grid.
double lowest_end_of(TerrainLevel const& level, Channels const& rivers, Window const& window);

/// Mean slope of a window as a tangent, for this number of metres per unit.
double mean_tangent(TerrainLevel const& level, Window const& window, double metres, Run const& run);

/// The same as share_of_target() on a coarse level, where slopes are gentler.
double coarse_share_of_target(TerrainLevel const& level, Window const& window, double metres,
                              EquilibriumParams const& params, Run const& run);

/// The caller's grid on the cells of a coarse level.
/// \param conversion of the finest level where it is known: with prescribed heights; null: one that gives about the
/// target
/// \return [m]
Raster<float> coarse_terrain(TerrainLevel const& level, Window const& window, HeightConversion const* conversion,
                             EquilibriumParams const& params, Run const& run);

/// Extracts the caller's grid from a solved finest level, in metres, with its flow directions. Tips that are still
/// perched are removed too, unless heads are kept. Lakes have their levels, which their rivers' water can keep.
EquilibriumTerrain extract_terrain(TerrainLevel level, Channels const& rivers, Window const& window,
                                   HeightConversion const& raise, std::vector<std::int64_t> shortened, Heads heads,
                                   Run const& run);

/// The same with rivers at or below their prescribed heights; reports walls and lowered cells.
EquilibriumTerrain extract_terrain_with_heights(TerrainLevel level, Channels const& rivers, Window const& window,
                                                HeightConversion const& raise, RiverHeights heights, Run const& run);

} // namespace thalweg::surface
