// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/surface/equilibrium/internal/level.hpp>

// Terrain between rivers with known heights. See docs/algorithms/equilibrium_levels.md.

namespace thalweg::surface {

/// nearest_of() with distances along straight lines.
NearestRiver straight_to(TerrainLevel const& level, std::vector<std::uint32_t> const& cells, Run const& run);

/// Part of an array of rows.
struct Rows {
    std::int64_t width;
    std::int64_t height;
    std::int64_t stride; ///< from row to row
};
struct BlurParams {
    std::int64_t reach = 1; ///< [cells] to each side
    int passes = 2;
};
/// Replaces values by their means in a square around each, a few times; beyond the border values continue.
void blur(float* first, Rows const& rows, BlurParams const& params, Run const& run);

/// How terrain that carries its rivers is found.
struct WallParams {
    float tolerance = 0.05F;    ///< [cells of the level] height of a river cell above the land beside it
    float least_height = 0.02F; ///< [cells of the level] of such land above the river that it drains to
    float reach = 3.0F;         ///< [cells of the level] beside a flow path
};
/// Along the flow paths from land beside river cells that stand above it: by how much [log] it has to rise, at most a
/// half; 0 elsewhere; empty: nowhere.
Cells<float> land_below_rivers(TerrainLevel const& level, WallParams const& params, Run const& run);

/// Marks the flow path from a land cell with that, or with how much it has to sink, if the cell shall have a height;
/// the greater of two marks stays.
void mark_to_move(TerrainLevel const& level, std::size_t from, float wanted, WallParams const& params,
                  Cells<float>& marks);
/// Marks of paths that fade beside them; empty: there are none.
Cells<float> spread_along(TerrainLevel const& level, Cells<float> marks, WallParams const& params, Run const& run);

/// By cell of a level: number of the link to which it drains; -1: none. link: by channel number
Cells<std::int32_t> links_of(TerrainLevel const& level, std::vector<std::int32_t> const& link, Run const& run);

/// By cell of a level: distance [cells of the level] to the nearest land that drains to another link than a neighbour,
/// or that is a crest.
Cells<float> distance_to_divides(TerrainLevel const& level, std::vector<std::int32_t> const& link, Run const& run);

} // namespace thalweg::surface
