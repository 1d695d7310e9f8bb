// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

// Idea: The hypsometric curve is the list of heights in order, read at 101 places. Nothing has to
// be sorted for that. The bits of a float are turned into an unsigned number in the same order, and
// read as three digits of 11, 11 and 10 bits. The first pass counts the cells by their first digit;
// that tells for each place which first digit it has, and the next pass counts only cells with
// these digits by their second one. After three passes each of the 101 heights is known exactly.
// Source: the curve by Strahler 1952, the integral by Pike and Wilson 1971; the counting by radix
// is ours.
// Cost: O(n), a count before three passes and a mean after them; memory a few megabytes, whatever
// the DEM's size. Passes run on all cores.
// Not for: heights interpolated between cells; the DEM without its sea: set cells of the sea to NaN
// first.
// Example:
//     Hypsometry const curve = hypsometry(dem);
//     double const median_m = curve.points[50].z;
// More: docs/relief_measures.md.

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
