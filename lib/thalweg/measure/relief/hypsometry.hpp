// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::measure {

/// A hypsometric point.
struct HypsometricPoint {
    double share_above = 0.0; ///< [0,1] of the area
    double z = 0.0;           ///< [m]
};

/// What hypsometry() returns.
struct Hypsometry {
    double integral = 0.5;                ///< [0,1] (mean - min) / (max - min)
    std::vector<HypsometricPoint> points; ///< at shares 0, 0.01, ..., 1: from the highest cell to the lowest
};

/// How much of a DEM's area lies above which height; NaN cells are left out.
/// \param dem [m] heights by cell; NaN: no data
/// \param run progress, log, stop token and number of threads
/// \return of n heights from the highest down, that of place floor(share (n - 1)), places from 0: heights of cells,
/// none interpolated. Land of one height has the integral 0.5, as has all land that lies alike above and below its
/// middle. The same bits for any number of threads. Heights are counted digit by digit, not sorted: beside the DEM it
/// takes a few megabytes.
/// \throws BadInput when no cell has data or a height is infinite
/// \throws Cancelled
///
/// Source: \cite strahler1952; the integral by \cite pike1971.
Hypsometry hypsometry(Raster<float> const& dem, Run const& run = {});

} // namespace thalweg::measure
