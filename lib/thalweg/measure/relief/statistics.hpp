// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/statistics/field_statistics.hpp>

// Idea: The numbers by which Zhang, Liu and Li describe terrain. Sums are taken row by row,
// relative to one height of the DEM, with compensation; rows are then added in their order. So
// large offsets cost no digits, a plain has a deviation of exactly 0, and any number of threads
// gives the same bits. The fractal dimension is 3 - H: mean squared differences of heights grow as
// lag^(2 H), and H is the slope of that line of logarithms. The correlation length is the lag at
// which the correlation falls to 1/e.
// Source: Zhang, Liu and Li (zhang in docs/references.bib), table 4 and sections 2 and 3.4.
// Cost: two passes for moments, one for each lag of the dimension, O(n log n) for the correlation
// at all lags. Memory: a few rows. Rows run on all cores.
// Not for: correlation lengths above half the DEM's extent: they are extrapolated. slope_rad takes
// a cell for 1 m, as in the paper's table: slope_true_deg has the true slope.
// Example:
//     Statistics const found = statistics(dem);
//     double const exponent = 3.0 - found.dimension;
//     bool const is_plain = found.std == 0.0;
// More: docs/statistics.md.

namespace thalweg::measure {

/// An extreme height and its cell.
struct Extreme {
    double z = 0.0; ///< [m]
    Cell cell;      ///< of several the first by index
};

/// What statistics() returns.
struct Statistics {
    std::int64_t cells = 0; ///< cells with data
    std::int64_t nodata = 0;
    double mean = 0.0; ///< [m]
    double std = 0.0;  ///< [m] population standard deviation
    Extreme min;
    Extreme max;
    double slope_rad =
        0.0; ///< [rad] mean of arctan |grad z| with z in metres and a spacing of one cell (Zhang, Liu and Li)
    double slope_true_deg = 0.0; ///< [deg] mean slope with the true cell size

    // NaN if undefined: on a plain, or along an axis of fewer than about four cells.
    double skew = 0.0;             ///< [-] population
    double kurtosis = 0.0;         ///< [-] population excess kurtosis
    double roughness_m = 0.0;      ///< [m] mean absolute difference of neighbours, averaged over rows and columns
    solver::CorrelationLength lx;  ///< [cells] along rows
    solver::CorrelationLength ly;  ///< [cells] along columns
    double dimension = 0.0;        ///< [-] fractal dimension from lags 1 to 5
    double dimension_dyadic = 0.0; ///< [-] fractal dimension from lags 1, 2, 4, 8, 16, 32, up to the DEM's extent
};

/// Computes mean, deviation, extremes, slope, correlation and fractal dimension of a DEM. Slopes are central
/// differences, one-sided at the border and beside holes; an axis without neighbours counts as level. A correlation
/// length is where the correlation falls to 1/e within half the extent, else from a fit (extrapolated).
/// \param dem [m] by cell; NaN: no data, left out with their pairs
/// \return the same bits for any number of threads; memory beside the DEM is a few rows
/// \throws BadInput when no cell has data, a height is infinite or the cell size is not positive
///
/// Source: \cite zhang, table 4 (slope in radians on unit cells; population deviation; roughness is not defined there)
/// and sections 2 and 3.4.
Statistics statistics(Raster<float> const& dem, Run const& run = {});

} // namespace thalweg::measure
