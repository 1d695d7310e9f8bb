// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/spectral/circulant.hpp>

// Idea: Set mean, deviation, correlation lengths, slope, dimension and extremes one after another,
// and each undoes those before. Here all are met at once: each statistic's derivative by every
// height is a field g; multiplied by the prior's covariance C it becomes the smooth change that
// moves that statistic with the least energy. A small linear system says how much of each, a
// Gauss-Newton step is taken, and again. Kriging keeps extremes and fixed heights exact during all
// steps. Heights near an extreme are bent below it, not clipped, so that they still respond. A step
// that makes things worse is undone and halved.
// Source: targets of Zhang, Liu and Li, table 4; bound of the deviation Bhatia and Davis 2000; the
// method is ours: docs/decisions/0008-projection.md.
// Cost: O(n log n) for each of four to fifteen steps (Fourier transforms), 150 bytes a cell; O(f^3)
// for f fixed heights, 2000 at most. docs/statistics.md: 20 s for 1197 x 643 cells. All cores.
// Not for: terrain that should look like a DEM: these statistics do not describe valleys. Terrain
// far from Gaussian, such as a TIN, may not converge; take its coarse forms only (with_fine_forms).
// Contradictory targets are met as far as possible (`converged`).
// Example:
//     Targets const targets{.mean = 536.0, .std = 131.6, .lx_cells = 20.7, .slope_rad = 1.499};
//     MatchedDem const matched = match_statistics(dem, targets);
//     bool const all_met = matched.converged;
// More: docs/statistics.md, "How all of them are met".

namespace thalweg::fractal {

/// A prescribed height of a cell.
struct FixedHeight {
    Cell cell;
    double z = 0.0; ///< [m]
};

/// Statistics that a DEM is matched to, by the definitions of measure::statistics; an empty one is free.
struct Targets {
    std::optional<double> mean{};      ///< [m]
    std::optional<double> std{};       ///< [m] > 0
    std::optional<FixedHeight> max{};  ///< the single highest cell
    std::optional<FixedHeight> min{};  ///< the single lowest cell
    std::optional<double> lx_cells{};  ///< [cells] > 0
    std::optional<double> ly_cells{};  ///< [cells] > 0
    std::optional<double> slope_rad{}; ///< [rad] in (0, pi/2)
    std::optional<double> dimension{}; ///< in (2, 3)
};

/// Options of match_statistics().
struct MatchParams {
    solver::StableCovariance prior{}; ///< covariance of the changes; ideally the DEM's own
    int iterations = 60;              ///< [0, 1000]
    double tolerance = 1e-4; ///< [0, 1] relative to each statistic's value; for the mean to the standard deviation
    double gap_m = 0.5;      ///< [m] > 0, from the extremes to all other cells; at most a thousandth of the relief
};

/// The result for one statistic.
struct Residual {
    std::string name;   ///< "mean", "std", "lx_cells", "ly_cells", "slope_rad", "dimension", "max", "min"
    double asked = 0.0; ///< [as named]
    double got = 0.0;   ///< [as named] NaN: undefined
    double error = 0.0; ///< relative to the target; for mean, max and min to the standard deviation
};

/// What match_statistics() returns.
struct MatchedDem {
    Raster<float> dem;
    std::vector<Residual> residuals; ///< one per target
    bool converged = false;          ///< every error is within the tolerance
    int iterations = 0;
    std::int64_t limited_cells = 0; ///< limited because they would be near or beyond an extreme
    double largest_error = 0.0;     ///< of all residuals
};

/// Most prescribed heights, extremes included: a dense matrix of that size is solved.
inline constexpr std::size_t most_fixed = 2000;

/// Changes a DEM as little as possible so that it has all target statistics at once, and extremes and fixed heights
/// exactly: Gauss-Newton steps of least energy in the prior's covariance, conditioned on the fixed heights; heights
/// near an extreme are bent so that none reaches it. Memory: about 150 bytes a cell.
/// \param dem [m] by cell; NaN: no data, unchanged
/// \param targets statistics to match
/// \param fixed heights of cells, at most most_fixed with the extremes
/// \return the best of all steps, with its residuals: contradictory targets are met as far as possible, and `converged`
/// is false. The same bits for any number of threads.
/// \throws BadParameter when a target is outside its range, the mean is not between the extremes, std^2 exceeds (max -
/// mean) (mean - min), both extremes are at one cell, or an extreme is off the grid or in a cell without data
/// \throws BadInput when a fixed height is off the grid or in a cell without data, contradicts another at its cell, or
/// there are too many
///
/// Source: \cite zhang, table 4; \cite bhatia2000 for the bound.
MatchedDem match_statistics(Raster<float> const& dem, Targets const& targets,
                            std::vector<FixedHeight> const& fixed = {}, MatchParams const& params = {},
                            Run const& run = {});

/// \internal
/// Checks whether any DEM on the grid can have the statistics.
/// \param dem [m] by cell; NaN: no data
/// \param targets statistics to match
/// \throws BadParameter with the numbers, as match_statistics
void check_targets(Raster<float> const& dem, Targets const& targets);

/// \internal
/// Collects the heights to keep.
/// \param dem [m] by cell; NaN: no data
/// \param targets with extremes, if any
/// \param fixed heights of cells
/// \return extremes first, each cell once
/// \throws BadInput as match_statistics
std::vector<FixedHeight> kept_heights(Raster<float> const& dem, Targets const& targets,
                                      std::vector<FixedHeight> const& fixed);

/// Combines the coarse forms of one DEM with the fine forms of another: the first's means over a Gaussian window, plus
/// the second's differences from such means. The border mirrors what lies beyond.
/// \param land [m] by cell: the DEM with the coarse forms
/// \param fine [m] by cell, on the same grid: the DEM with the fine forms
/// \param cells [cells] (0, 1000] standard deviation of the window
/// \return for two equal DEMs the same DEM, to rounding; the same bits for any number of threads
/// \throws BadParameter when cells is outside its range
/// \throws BadInput when the grids differ or a height is not finite
Raster<float> with_fine_forms(Raster<float> const& land, Raster<float> const& fine, double cells, Run const& run = {});

} // namespace thalweg::fractal
