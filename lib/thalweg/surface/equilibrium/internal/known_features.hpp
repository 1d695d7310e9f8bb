// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/surface/equilibrium/features.hpp>
#include <thalweg/surface/equilibrium/internal/land.hpp>
#include <thalweg/surface/equilibrium/internal/level.hpp>
#include <thalweg/surface/equilibrium/internal/rebuild_steps.hpp>

// Known heights and crests. See docs/algorithms/equilibrium_levels.md.

namespace thalweg::surface {

/// \throws BadInput for cells outside the grid or out of order, or infinite heights. self: the stage
void check_features(Grid const& grid, std::vector<FeatureCell> const& features, char const* self);

/// Terrain on the caller's grid as one level [m], and what its land rises from.
struct OverRivers {
    TerrainLevel level;
    NearestRiver near;
    std::vector<float> river_z; ///< [m] by number
};
OverRivers over_rivers(Raster<float> const& dem, std::vector<std::int64_t> const& rivers, Run const& run);

/// Marks the land cells of a level that crests run through.
void set_crests(TerrainLevel& level, std::vector<FeatureCell> const& features, Grid const& grid);

/// Lets water flow by heights alone.
inline void open_crests(TerrainLevel& level) {
    level.crests.clear();
    level.is_crest.clear();
}

/// Land cells of a level with known heights, ascending; a coarse cell has the mean of its own.
struct KnownHeights {
    std::vector<std::uint32_t> cell;
    std::vector<float> z;
};
KnownHeights known_heights(TerrainLevel const& level, std::vector<FeatureCell> const& features, Grid const& grid);

/// A smooth field with given values at some cells, each fading to 0 over its reach [cells of the level] or sooner.
Cells<float> spread(TerrainLevel const& level, std::vector<std::uint32_t> const& cells,
                    std::vector<float> const& values, std::vector<float> const& reach, Run const& run);

/// Heights that pass through the known ones, changed no farther from these than to the nearest river.
Cells<float> through_known(TerrainLevel const& level, Cells<float> z, KnownHeights const& known,
                           NearestRiver const& near, Run const& run);

/// Pulls land towards known heights above the end of channel 0, less with the distance from them.
class PullToHeights {
public:
    PullToHeights(TerrainLevel& level, LandLaw const& law, KnownHeights known, Pull& pull, Run const& run);
    /// To be called after rivers changed.
    void follow_rivers(TerrainLevel& level, Pull const& pull);

private:
    std::size_t end_ = 0;
    float from_ = 0.0F; ///< height of the end
};

/// Sets the least heights of crest cells: above the land beside them, as far as slopes allow.
void raise_crests(TerrainLevel const& level, Cells<float>& floor);

/// As land_below_rivers() for crests with a higher and a lower side: these shall meet, the higher one sinks (< 0).
Cells<float> land_off_crests(TerrainLevel const& level, WallParams const& params, Run const& run);

/// Along the flow paths from known heights: by how much [log] land has to rise, or to sink (< 0), to have them.
Cells<float> land_off_known(TerrainLevel const& level, KnownHeights const& known, WallParams const& params,
                            Run const& run);

/// Calls visit(cell) for land beside crest cells, which are none and no banks; more than once beside several.
template <class Visit>
void each_beside_crest(TerrainLevel const& level, std::array<std::int64_t, 8> const& offsets, Visit visit) {
    for (std::uint32_t const crest : level.crests) {
        for (std::int64_t const offset : offsets) {
            std::size_t const n = moved(crest, offset);
            if ((level.type[n] == CellType::land || level.type[n] == CellType::rim) && level.is_crest[n] == 0) {
                visit(n);
            }
        }
    }
}
/// Turns water back that new directions lead onto crests. before: directions_beside_crests() as they were.
void keep_off_crests(TerrainLevel& level, std::vector<std::int8_t> const& before);
std::vector<std::int8_t> directions_beside_crests(TerrainLevel const& level);

} // namespace thalweg::surface
