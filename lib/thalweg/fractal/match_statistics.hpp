// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/spectral/stable_covariance.hpp>

namespace thalweg::fractal {

/// A height that a cell must have.
struct FixedHeight {
    Cell cell;
    double z = 0.0; ///< [m]
};

/// The statistics that a DEM must have, as measure::statistics estimates them; one that is not named is left as it
/// comes.
struct Targets {
    std::optional<double> mean{};      ///< [m]
    std::optional<double> std{};       ///< [m] > 0
    std::optional<FixedHeight> max{};  ///< no other cell is as high
    std::optional<FixedHeight> min{};  ///< no other cell is as low
    std::optional<double> lx_cells{};  ///< [cells] > 0
    std::optional<double> ly_cells{};  ///< [cells] > 0
    std::optional<double> slope_rad{}; ///< [rad] in (0, pi/2)
    std::optional<double> dimension{}; ///< in (2, 3)
};

/// Options of project().
struct MatchParams {
    solver::StableCovariance prior{}; ///< how changes at two places go together; best that of the land handed in
    int iterations = 60;              ///< [0, 1000]
    double tolerance = 1e-4;          ///< [0, 1] of each statistic's value; of the deviation for the mean
    double gap_m = 0.5; ///< [m] > 0 between the extremes and all other cells; at most a thousandth of the relief
};

/// How a statistic came out.
struct Residual {
    std::string name; ///< "mean", "std", "lx_cells", "ly_cells", "slope_rad", "dimension", "max", "min"
    double asked = 0.0;
    double got = 0.0;   ///< NaN when the heights tell none
    double error = 0.0; ///< of the value asked for; of the deviation for mean, max and min
};

/// What project() returns.
struct MatchedDem {
    Raster<float> dem;
    std::vector<Residual> residuals; ///< one for each target named
    bool converged = false;          ///< every error is within the tolerance
    int iterations = 0;
    std::int64_t limited_cells = 0; ///< that would lie near or beyond an extreme, and are bent back below or above it
    double largest_error = 0.0;     ///< of all residuals
};

/// Most heights that can be fixed, extremes among them: a dense matrix of that size is solved.
inline constexpr std::size_t most_fixed = 2000;

/// Changes a land as little as it takes to have all the statistics asked for at once, extremes and fixed heights
/// exactly.
/// \pre a DEM, NaN where there is no data: such cells do not count and stay; targets; heights to keep, at most
/// most_fixed with the extremes; params, of which the prior says what "little" means.
/// \param dem [m] heights by cell; NaN: no data
/// \param targets the target statistics
/// \param fixed what keeps its place or height
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return Gauss-Newton steps of least energy in the prior's covariance, conditioned on the fixed heights; heights near
/// an extreme are bent so that none reaches it. The best of all steps, with what is left in residuals: targets that
/// contradict one another or the fixed heights are met as far as they can be, and converged says so. The same bits for
/// any number of threads. Holds about 150 bytes a cell.
/// \throws BadParameter when a target is out of its range, the mean is not between the extremes, std^2 exceeds (max -
/// mean) (mean - min), both extremes are asked of one cell, or an extreme lies off the grid or in a hole
/// \throws BadInput when a fixed height does, contradicts another at its cell, or there are too many
/// \throws Cancelled
///
/// Source: \cite zhang, table 4; \cite bhatia2000 for the bound.
MatchedDem match_statistics(Raster<float> const& dem, Targets const& targets,
                            std::vector<FixedHeight> const& fixed = {}, MatchParams const& params = {},
                            Run const& run = {});

} // namespace thalweg::fractal
