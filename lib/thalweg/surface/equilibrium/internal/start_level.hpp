// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/channels.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>
#include <thalweg/surface/equilibrium/internal/erodibility.hpp>
#include <thalweg/surface/equilibrium/internal/level.hpp>

// A level before its first round. See docs/algorithms/equilibrium_levels.md.

namespace thalweg::surface {

/// Whether the terrain continues beyond the grid.
inline bool goes_on(Edge edge) {
    return edge == Edge::open || edge == Edge::mainland;
}

/// Whether the sea, at height 0, lies where there is no land.
inline bool has_sea(Edge edge) {
    return edge == Edge::coast || edge == Edge::mainland;
}

/// The solver's domain: the caller's grid plus a margin into which the terrain may continue.
struct PaddedTerrain {
    Grid grid;           ///< without the frame
    std::int64_t margin; ///< [cells] on each side
    RiverCells rivers; ///< in the frame of that grid; rivers that cross the border continue straight through the margin
    Mask land;         ///< without cells: all
    ErodibilityFields fields;
};
PaddedTerrain padded(Channels const& rivers, EquilibriumFields const& fields, EquilibriumParams const& params);

/// The region of which the caller's grid is a window. Coarse levels are solved on all of it.
struct Region {
    std::size_t level = 0;   ///< number of its finest level; 0: there is no region
    std::int64_t margin = 0; ///< [finest cells] beyond the grid on each side, in whole cells of that level
};

/// A level without its frame.
struct LevelExtent {
    std::int64_t width = 0;
    std::int64_t height = 0;
    Cell corner; ///< as TerrainLevel
};

/// The content of a level's frame before it is solved.
struct LevelInput {
    LevelExtent extent;
    RiverCells rivers;
    Mask land;
};

/// Makes the levels from the finest to one of about forty cells a side, the coarse ones of the region.
std::vector<LevelInput> level_inputs(PaddedTerrain& land, Region const& region, Grid const& grid, std::uint64_t seed);

/// Coarsens a land mask inside a level's frame: 1 if at least half of a cell's finer cells are land; without cells:
/// all.
Mask coarsened(Mask const& land);

/// Sets the type of each cell of a level, from its rivers, the land mask (inside the frame; without cells: all land)
/// and the boundary. kept: cells beside rivers are banks.
enum class RiverBanks : std::uint8_t { none, kept };
void set_cell_types(TerrainLevel& level, Mask const& land, Edge edge, RiverBanks banks);

/// Nodes lie up to a third of a cell from the centres of their cells, at one of eight places along each axis, so that
/// flow directions do not follow the lattice. A code is eastward + jitter_places * southward.
inline constexpr int jitter_places = 8;
inline constexpr int jitter_cell = 10; ///< distances of two places in a cell's side

/// Places the nodes of a level's row at random, the frame's included.
void jitter_codes(TerrainLevel const& level, std::int64_t row, std::uint8_t* codes);
std::uint8_t jitter_code(TerrainLevel const& level, std::size_t cell);

/// What lies beyond an open boundary.
enum class Beyond : std::uint8_t {
    rivers, ///< a river at every place, as high as the nearest one inside
    valleys ///< basins with rivers of their own, lower than the heads inside
};

/// The boundary cells of open terrain: the frame in order, and land beside masked-out cells.
struct BoundaryCells {
    /// By boundary cell: its index and the river nearest to it.
    struct Part {
        std::vector<std::uint32_t> cell;
        std::vector<std::uint32_t> river; ///< its cell; of the sea the sea cell itself
        std::vector<std::uint32_t> inner; ///< the cell itself, or its neighbour inside the frame
        std::vector<float> far;           ///< [finest cells] from the river; of the sea 0
    };
    Part ring; ///< clockwise from the north-west corner, sea cells included
    Part inside;
    Beyond beyond = Beyond::rivers;
};
BoundaryCells boundary_cells(TerrainLevel const& level, NearestRiver const& near, Beyond beyond);

/// By inner cell, the lowest possible valley: a large river still falls from it to one of the level.
Cells<float> lowest_valleys(TerrainLevel const& level);
/// The height of a valley beyond, some way [finest cells] from the nearest river.
float valley_beyond(float river, float far, float lowest);

/// Sets their heights: smoothed along the frame, and above the rivers that they touch. Rivers: as high as the nearest.
/// Valleys: lower by the fall of a river's first reaches, more with distance, but nowhere so low that a large river
/// could not flow from there to one of the grid.
void set_boundary_heights(TerrainLevel& level, BoundaryCells const& edge);

/// Initialises the coarsest level: a gentle rise away from where water leaves, plus random noise.
void start_from_nothing(TerrainLevel& level, NearestRiver const& near, std::uint64_t seed, Run const& run);

/// How a level departs from the coarser one.
struct Departure {
    float rough = 0.15F; ///< [cells of the level] random heights
    float bend = 1.0F;   ///< [coarse cells] largest displacement
};

/// Initialises a level: interpolated heights of the coarser one, displaced, plus random noise.
void start_from(TerrainLevel& level, TerrainLevel const& coarse, std::uint64_t seed, Departure const& departure,
                Run const& run);
/// Adds such noise to heights.
void roughen(TerrainLevel& level, std::uint64_t seed, float rough, Run const& run);

/// Sets the heights that are not free: sea, outside, and rivers that rise slightly from their ends. end_z: by river
/// cell, for those that end; empty: 0.
void start_rivers(TerrainLevel& level, std::vector<float> const& end_z = {});

} // namespace thalweg::surface
