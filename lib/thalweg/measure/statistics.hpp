// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run.hpp>

namespace thalweg::measure {

struct Extreme {
    double z = 0.0; ///< [m]
    Cell cell;      ///< the first such cell by index
};

struct Statistics {
    std::int64_t cells = 0; ///< cells with data
    std::int64_t nodata = 0;
    double mean = 0.0; ///< [m]
    double std = 0.0;  ///< [m] population
    Extreme min;
    Extreme max;
    double slope_rad = 0.0; ///< [rad] mean of arctan |grad z| with z in metres and a spacing of one cell (paper 001)
    double slope_true_deg = 0.0; ///< [deg] mean slope with the cell's size
};

/// Mean, deviation, extremes and slope of a DEM; NaN cells are left out.
/// Gives: slopes by central differences along columns and rows; one-sided at the border and beside a hole; an axis
/// along which a cell has no neighbour counts as level. The same bits for any number of threads. Throws: BadInput when
/// no cell has data, a height is infinite or the cell size is not positive; Cancelled. Source: paper 001, table 4
/// (slope in radians on unit cells; population deviation).
Statistics statistics(Raster<float> const& dem, Run const& run = {});

} // namespace thalweg::measure
