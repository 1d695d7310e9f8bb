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

/// How steep land is, and where it faces. NaN where no cell tells.
struct Slopes {
    std::int64_t cells = 0; ///< that have a height, and eight neighbours with one
    double mean_deg = std::numeric_limits<double>::quiet_NaN();
    double std_deg = std::numeric_limits<double>::quiet_NaN();            ///< of all these cells
    std::array<double, slope_percents.size()> percentile_deg{};           ///< at slope_percents, within 0.01
    double tangent_mean = std::numeric_limits<double>::quiet_NaN();       ///< [m/m]
    double tangent_cv = std::numeric_limits<double>::quiet_NaN();         ///< [-] deviation over mean
    std::vector<double> shares;                                           ///< [0,1] of the cells, 2 degrees each, to 90
    double aspects_along_grid = std::numeric_limits<double>::quiet_NaN(); ///< [-] 1 where they are even: see below
    double aspects_on_grid = std::numeric_limits<double>::quiet_NaN();    ///< [-] likewise, close to the directions
};

/// Slopes of a DEM by Horn's eight neighbours.
/// \param dem [m] heights by cell; NaN: no data
/// \param run progress, log, stop token and number of threads
/// \return as gdaldem's slope, borders and cells beside holes left out. Aspects: of the cells that are not level, the
/// share that faces within 11.25 (along) or 2.5 degrees (on) of one of the grid's eight directions, over the share that
/// would if all aspects were as frequent, 1/2 or 1/9. The same bits for any number of threads.
/// \throws BadInput when the cell size is not positive
/// \throws Cancelled
///
/// Source: \cite horn1981.
Slopes slopes(Raster<float> const& dem, Run const& run = {});

} // namespace thalweg::measure
