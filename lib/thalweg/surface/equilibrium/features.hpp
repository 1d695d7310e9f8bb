// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

// Idea: A DEM is moved to known heights without steps. What is missing at each place is spread as a
// smooth field that fades to 0 at the distance of its nearest river, so that rivers keep their
// heights. Wide fields go first: at each radius, from the longest down by halves, the rest that is
// still missing is blurred and added, so that single places correct what wider ones left.
// Source: ours: docs/decisions/0032-rebuild.md, "Known heights and ridges".
// Cost: a blur and a distance transform of O(cells) for each halving of the longest reach. All
// cores.
// Not for: terrain that shall be shaped by the heights (equilibrium() and rebuild() take the same
// features, and let water and slopes follow). Heights that contradict their river give slopes as
// steep as it takes.
// Example:
//     std::vector<FeatureCell> const summits = {{.cell = grid.index({40, 30}), .z = 812.0F}};
//     Raster<float> const moved = through_heights(dem, river_cells, summits);
// More: docs/rebuild.md, "Points and ridges between the rivers".

namespace thalweg::surface {

/// A cell that terrain is drawn through.
struct FeatureCell {
    std::int64_t cell = 0;                             ///< index in the grid
    float z = std::numeric_limits<float>::quiet_NaN(); ///< [m]; NaN: free
    bool crest = false;                                ///< part of a ridge: no water crosses it
};

/// Moves terrain to known heights, and the land around each by less with the distance, as far as to the nearest river
/// at most.
/// \param dem [m]; NaN: no data
/// \param rivers cells that keep their heights; at least one
/// \param features by cell, each once
/// \return the known heights bit for bit, but for cells of rivers and without data
/// \throws BadInput for a cell outside the grid, cells out of order, or no river
Raster<float> through_heights(Raster<float> dem, std::vector<std::int64_t> const& rivers,
                              std::vector<FeatureCell> const& features, Run const& run = {});

} // namespace thalweg::surface
