// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/statistics/correlation_length.hpp>

namespace thalweg::measure {

/// A height and its place.
struct Extreme {
    double z = 0.0; ///< [m]
    Cell cell;      ///< the first such cell by index
};

/// What statistics() returns.
struct Statistics {
    std::int64_t cells = 0; ///< cells with data
    std::int64_t nodata = 0;
    double mean = 0.0; ///< [m]
    double std = 0.0;  ///< [m] population
    Extreme min;
    Extreme max;
    double slope_rad =
        0.0; ///< [rad] mean of arctan |grad z| with z in metres and a spacing of one cell (Zhang, Liu and Li)
    double slope_true_deg = 0.0; ///< [deg] mean slope with the cell's size

    // NaN where the heights tell none: on a plain, or along an axis of fewer than four cells or so.
    double skew = 0.0;             ///< [-] population
    double kurtosis = 0.0;         ///< [-] population, above that of the normal distribution, which has 0
    double roughness_m = 0.0;      ///< [m] mean height difference of neighbours, rows and columns averaged
    solver::CorrelationLength lx;  ///< [cells] along rows
    solver::CorrelationLength ly;  ///< [cells] along columns
    double dimension = 0.0;        ///< [-] fractal dimension from the lags 1 to 5
    double dimension_dyadic = 0.0; ///< [-] the same from the lags 1, 2, 4, 8, 16, 32, as far as the DEM reaches
};

/// Mean, deviation, extremes, slope, correlation and fractal dimension of a DEM; NaN cells are left out, and so are
/// pairs with them.
/// \param dem [m] heights by cell; NaN: no data
/// \param run progress, log, stop token and number of threads
/// \return slopes by central differences along columns and rows; one-sided at the border and beside a hole; an axis
/// along which a cell has no neighbour counts as level. Correlation lengths where the correlation of all pairs of cells
/// along an axis falls to 1/e within half the extent, else of a fit (extrapolated). The same bits for any number of
/// threads; memory for some rows beside the DEM.
/// \throws BadInput when no cell has data, a height is infinite or the cell size is not positive
/// \throws Cancelled
///
/// Source: \cite zhang, table 4 (slope in radians on unit cells; population deviation; roughness is not defined there)
/// and sections 2 and 3.4.
Statistics statistics(Raster<float> const& dem, Run const& run = {});

} // namespace thalweg::measure
