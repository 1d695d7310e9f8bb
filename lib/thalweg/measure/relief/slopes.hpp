// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

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
/// \param run progress, log, stop token and number of threads
/// \return slopes as gdaldem's; the same bits for any number of threads
/// \throws BadInput when the cell size is not positive
/// \throws Cancelled
///
/// Source: \cite horn1981.
Slopes slopes(Raster<float> const& dem, Run const& run = {});

} // namespace thalweg::measure
