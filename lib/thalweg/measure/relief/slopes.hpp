// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

// Idea: Slope and aspect of a cell come from a weighted difference of its eight neighbours (Horn):
// more noise cancels than in a difference of two. Each slope also goes into a class of 0.01
// degrees, so that percentiles come without a sorted list. Two indices look for the grid in the
// terrain: how many more cells face one of its eight directions than would by chance, and how large
// the largest patch of nearly level land is. perched and sunken_share look for rivers that stand on
// walls.
// Source: Horn 1981. The two indices are ours: docs/relief_measures.md.
// Cost: O(n). slopes runs on all cores, by blocks of rows.
// Not for: the border and cells beside no data, which are left out; cells of a size in degrees. The
// slope is one over two cells: on a coarser DEM of the same land it is gentler.
// Example:
//     Slopes const found = slopes(dem);
//     double const median_deg = found.percentile_deg[3]; // of slope_percents
//     double const below_rivers = sunken_share(dem, river_cells);
// More: docs/relief_measures.md, "Methods".

namespace thalweg::measure {

inline constexpr std::array<int, 7> slope_percents = {5, 10, 25, 50, 75, 90, 95};

/// Slope and aspect distributions of a DEM; NaN: no cell counts.
struct Slopes {
    std::int64_t cells = 0; ///< with data and eight neighbours with data
    double mean_deg = std::numeric_limits<double>::quiet_NaN();
    double std_deg = std::numeric_limits<double>::quiet_NaN();      ///< population standard deviation
    std::array<double, slope_percents.size()> percentile_deg{};     ///< at slope_percents, within 0.01
    double tangent_mean = std::numeric_limits<double>::quiet_NaN(); ///< [m/m]
    double tangent_cv = std::numeric_limits<double>::quiet_NaN();   ///< [-] coefficient of variation
    std::vector<double> shares;                                     ///< [0, 1] of cells, classes of 2 degrees up to 90
    /// [-] 1: uniform aspects; within 11.25 degrees of a grid direction
    double aspects_along_grid = std::numeric_limits<double>::quiet_NaN();
    /// [-] 1: uniform aspects; within 2.5 degrees of a grid direction
    double aspects_on_grid = std::numeric_limits<double>::quiet_NaN();
};

/// Computes slopes and aspects by Horn's formula, without borders and cells beside holes. Aspect bias: share of the
/// sloping cells that face within 11.25 or 2.5 degrees of one of the grid's eight directions, over that share for
/// uniform aspects (1/2 or 1/9).
/// \param dem [m] by cell; NaN: no data
/// \return slopes as gdaldem's; the same bits for any number of threads
/// \throws BadInput when the cell size is not positive
///
/// Source: \cite horn1981.
Slopes slopes(Raster<float> const& dem, Run const& run = {});

/// Options of level_patch().
struct LevelPatchParams {
    double below_deg = 3.0; ///< [degrees] (0, 90) slope by Horn's formula
};

/// The largest 8-connected patch of gentle slopes.
struct LevelPatch {
    std::int64_t cells = 0; ///< of the patch
    std::int64_t land = 0;  ///< with data and eight neighbours with data, lakes left out
};

/// Finds the largest 8-connected patch of cells with a slope below below_deg. A cell as high as all its neighbours
/// is a lake's surface and counts nowhere.
/// \param dem [m] by cell; NaN: no data
/// \return cells; the same for any number of threads
/// \throws BadParameter when below_deg is outside its range
/// \throws BadInput when the cell size is not positive
LevelPatch level_patch(Raster<float> const& dem, LevelPatchParams const& params = {}, Run const& run = {});

/// Finds river cells perched above their surroundings, such as walls and tips beside deeper valleys.
/// \param dem [m] by cell; NaN: no data
/// \param cells indices of river cells
/// \param rise_m [m] >= 0, mean slope (tangent) times cell size
/// \return in order: the cells more than rise_m above the lowest of the sixteen cells two columns or rows away, as far
/// as these are in the DEM; cells without data are not perched
/// \throws BadParameter when rise_m is not a number >= 0
/// \throws BadInput when a cell is outside the DEM
std::vector<std::int64_t> perched(Raster<float> const& dem, std::span<std::int64_t const> cells, double rise_m);

/// Options of sunken_share().
struct SunkenShareParams {
    double tolerance_m = 1.0; ///< [m] >= 0
    bool has_sea = false;     ///< cells without data are the sea, at height 0; else gaps
};

/// Finds how much land lies lower than the river, or the sea, nearest to it: next to none, but where walls hold rivers
/// up.
/// \param dem [m] by cell; NaN: no data
/// \param cells indices of river cells, at least one
/// \return [0, 1] of the cells with data beside rivers; 0 without such cells. Real terrain: 0.03 or less.
/// \throws BadParameter when tolerance_m is not a number >= 0
/// \throws BadInput when a cell is outside the DEM, or there is none
double sunken_share(Raster<float> const& dem, std::span<std::int64_t const> cells, SunkenShareParams const& params = {},
                    Run const& run = {});

} // namespace thalweg::measure
