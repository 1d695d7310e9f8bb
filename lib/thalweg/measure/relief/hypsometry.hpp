// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::measure {

/// A point of the hypsometric curve.
struct HypsometricPoint {
    double share_above = 0.0; ///< [0, 1] of the area
    double z = 0.0;           ///< [m]
};

/// What hypsometry() returns.
struct Hypsometry {
    double integral = 0.5;                ///< [0, 1] (mean - min) / (max - min)
    std::vector<HypsometricPoint> points; ///< at shares 0, 0.01, ..., 1: from the highest cell to the lowest
};

/// Computes the hypsometric curve and integral of a DEM. Heights are counted by radix, not sorted: memory beside the
/// DEM is a few megabytes.
/// \param dem [m] by cell; NaN: no data, left out
/// \return heights of cells, not interpolated: of n heights in descending order that at index floor(share (n - 1)). A
/// level DEM has the integral 0.5. The same bits for any number of threads.
/// \throws BadInput when no cell has data or a height is infinite
///
/// Source: \cite strahler1952; the integral by \cite pike1971.
Hypsometry hypsometry(Raster<float> const& dem, Run const& run = {});

} // namespace thalweg::measure
