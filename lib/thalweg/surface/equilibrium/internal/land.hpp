// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/run/run.hpp>
#include <thalweg/surface/equilibrium/internal/level.hpp>

// The terrain between rivers. See docs/algorithms/equilibrium_levels.md.

namespace thalweg::surface {

/// Finds a receiver for every cell and raises cells where necessary: banks drain to the steepest river cell beside
/// them, other land by a flood from the outlets. Each land cell ends up at least level.least above its receiver,
/// banks above all river cells beside them. Cells that cannot drain become outside. Source: Barnes 2014, with buckets
/// instead of a heap: cells of one bucket are taken in any order, which changes the order of cells but not the law.
void flood_terrain(TerrainLevel& level);

/// Directs land cells to their steepest neighbour, by the distances of jittered nodes, banks to their steepest river
/// cell. A cell without a lower neighbour keeps its direction: no cell is below its receiver, so that directions never
/// form a cycle.
void set_steepest_receivers(TerrainLevel& level, Run const& run);

/// Computes the contributing area of every cell: follows water from each cell without donors as long as all donors have
/// arrived, in bands of rows on all workers, then across them.
/// \param rows of a band at least
void accumulate_areas(TerrainLevel& level, Run const& run, std::int64_t rows = 128);

/// What else holds land cells, by cell; empty: nothing.
struct Pull {
    Cells<float> stiffness; ///< of a spring towards a given height, whose force there is part of the uplift
    Cells<float> floor;     ///< least heights
};

/// One sweep over the terrain, receivers first: sets each cell to the height at which uplift balances incision, towards
/// the receiver's new height, and creep, by the neighbours' heights before the sweep (rivers' as they are). Each cell
/// ends up at least level.least above its receiver and at most its cap (banks may have to be higher: above every
/// river cell beside them). Areas of land are lost.
void relax_terrain(TerrainLevel& level, LandLaw const& law, Pull const& pull, Run const& run);

/// Mean slope of the cells that have four neighbours.
double mean_slope_deg(TerrainLevel const& level, Run const& run);

/// Lowers terrain that is far steeper above one of its neighbours than its cap allows: cliffs left by a removed river,
/// which would otherwise retreat by one row of cells a round. Banks and rivers are unchanged. The result is the largest
/// heights that satisfy this; every cell that had a lower neighbour still has one.
void slide_terrain(TerrainLevel& level, Run const& run);

struct FloorParams {
    double width_km = 0.0; ///< half width of a valley floor where 1 km² drains
    double cell_m = 1.0;
    std::uint64_t seed = 0;
};

/// Lowers the cap on slopes beside rivers to form valley floors that widen downstream: flat, with a concave foot as
/// wide again.
void valley_floors(TerrainLevel& level, FloorParams const& params, Run const& run);

} // namespace thalweg::surface
