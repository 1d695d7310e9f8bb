// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

// Idea: An island is the highest 42 % of the grid's cells by a height that falls outward as an oval
// does. Noise of many wavelengths bends the plane in which the oval lies, which makes bays and
// peninsulas, and moves its level, which makes the fine coast. Taking a share of cells instead of a
// level keeps the size of the land whatever the noise. Outlets are drawn from the coast one by one
// in random order, earlier where more land lies around them (the cube of its share), each at a
// distance from the others that is random, too; where too few fit, distances shrink by 0.7.
// Source: ours, but for the noise, which is Perlin's (1985); each octave is turned and shifted, so
// that no axis shows.
// Cost: O(n log n) for n cells (octaves; the level needs a partial sort). Rows run on all cores,
// lakes and islets are removed on one. Outlets: O(c log c) for c cells of coast.
// Not for: real coasts (network/import/land_and_sea.hpp). The noise has no physics: no cliffs, no
// deltas, no beaches.
// Example:
//     Mask const land = shape_island(grid, {.ruggedness = 0.6, .seed = 3});
//     std::vector<Cell> const outlets = spread_outlets(land, coast_cells(land), {.count = 12});
//     PlantedForest const rivers = plant_forest(land, outlets); // grow_forest.hpp
// More: docs/rivers.md, "Forests: many basins".

namespace thalweg::growth {

/// Options of shape_island().
struct IslandParams {
    double ruggedness = 0.5; ///< [0, 1] reach of fjords and capes; 0: an oval
    std::uint64_t seed = 7;
};

/// Draws an island that covers about two fifths of the grid: a bent oval with a coast moved by noise of all wavelengths
/// from the grid's side to 8 cells.
/// \param grid at least 16 x 16 cells
/// \return 1: land, without lagoons and without islets smaller than a thousandth of the grid; land keeps a fortieth of
/// the shorter side from the border. The same mask for any number of threads.
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput for a smaller grid
///
/// Source: gradient noise (\cite perlin1985), each octave turned.
Mask shape_island(Grid const& grid, IslandParams const& params = {}, Run const& run = {});

/// Lists the land cells that share a side with the sea or lie on the grid's border.
/// \param land 0: sea
/// \return ascending by index
std::vector<Cell> coast_cells(Mask const& land);

/// Options of spread_outlets().
struct SpreadOutletsParams {
    std::int64_t count = 0;    ///< [0, ...] number of outlets; 0: from every_cells
    double every_cells = 60.0; ///< [cells] > 0, length of coast per outlet
    std::uint64_t seed = 7;
};

/// Chooses outlets at random along a coast, more often in bays than on capes.
/// \param land 0: sea
/// \param coast cells where outlets may lie, at least one
/// \return `count` of these cells, in the order they were drawn, at least three cells apart; fewer if no more fit
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput for an empty coast
std::vector<Cell> spread_outlets(Mask const& land, std::vector<Cell> const& coast,
                                 SpreadOutletsParams const& params = {}, Run const& run = {});

} // namespace thalweg::growth
