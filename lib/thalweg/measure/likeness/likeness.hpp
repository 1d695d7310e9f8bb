// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/catchments.hpp>

// Idea: Terrains that were built around the same rivers are compared with the DEM of the place.
// Their heights agree partly because the rivers do, so the correlation of heights flatters every
// method; the height above the nearest river cell, away from the rivers, takes that part out.
// Heights say little of form: divides of both are therefore drawn between the catchments of the
// same reaches, and counted as found (of the DEM's) and as right (of the terrain's) within three
// cells. Slopes are compared as distributions (Kolmogorov-Smirnov), since no method knows where
// single steep cells lie.
// Source: ours: docs/rebuild.md and docs/decisions/0032-rebuild.md.
// Cost: O(n) and one flow field a terrain, and one exact distance transform. Sums of heights run on
// all cores.
// Not for: terrains around different rivers, which share no reaches; whether terrain is plausible
// where no DEM is known (measure/relief/relief.hpp).
// Example:
//     flow::Reaches const rivers = flow::reaches_of(network);
//     ComparedTerrains const compared = compare_terrains(dem, {other_dem}, rivers);
//     double const found = compared.terrains.front().divides_found;
// More: docs/rebuild.md, "Comparing it with a DEM".

namespace thalweg::measure {

/// How like a terrain is to a DEM; NaN: nothing to compare.
struct Likeness {
    double correlation = std::numeric_limits<double>::quiet_NaN(); ///< [-1, 1] of heights
    /// [-1, 1] of heights above the nearest river cell, more than three cells from it
    double correlation_above_river = std::numeric_limits<double>::quiet_NaN();
    double rmse_m = std::numeric_limits<double>::quiet_NaN();
    double bias_m = std::numeric_limits<double>::quiet_NaN(); ///< mean of the terrain minus the DEM
    /// [0, 1] of the cells that drain to a river in the DEM: they drain to the same reach
    double same_reach = std::numeric_limits<double>::quiet_NaN();
    double divides_found = std::numeric_limits<double>::quiet_NaN(); ///< [0, 1] of the DEM's, within three cells
    double divides_right = std::numeric_limits<double>::quiet_NaN(); ///< [0, 1] of the terrain's, within three cells
    /// [0, 1] largest difference of the shares of cells with a slope below any value (Kolmogorov-Smirnov)
    double slopes_difference = std::numeric_limits<double>::quiet_NaN();
};

/// What compare_terrains() returns.
struct ComparedTerrains {
    std::int64_t cells = 0;         ///< compared
    std::vector<Likeness> terrains; ///< in their order
    std::vector<Mask> divides;      ///< between catchments of reaches: of the DEM, then of the terrains
};

/// Cells of a DEM that compare_terrains() compares: with data, eight cells or more from the border.
/// \param dem [m] by cell; NaN: no data
Mask compared_cells(Raster<float> const& dem);

/// Compares terrains with a DEM around the same rivers. Divides are the cells on both sides of boundaries between
/// catchments, more than four cells from rivers.
/// \param dem [m] by cell; NaN: no data
/// \param terrains [m] on the DEM's grid; cells without data count nowhere
/// \param rivers reaches inside the grid
/// \throws BadInput when a terrain has another grid, or there is no river; as flow::route and flow::catchments
ComparedTerrains compare_terrains(Raster<float> const& dem, std::vector<Raster<float>> const& terrains,
                                  flow::Reaches const& rivers, Run const& run = {});

} // namespace thalweg::measure
