// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::solver {

/// Along rows (eastwards) or along columns (southwards).
enum class Axis { rows, columns };

/// Sums over all pairs of cells 0, 1, ... cells apart along an axis.
struct LagSums {
    std::vector<double> products; ///< [m2] of the two heights minus the datum
    std::vector<double> pairs;    ///< number of pairs with data
};

/// Computes lag sums by transforms of single rows or columns, in O(cells log), with memory for a few of these.
/// \param dem [m] by cell; NaN: no data
/// \param datum [m] subtracted from all heights
/// \param axis rows or columns
/// \param lags [0, cells along the axis) largest lag
/// \param run progress, log, stop token and number of threads
/// \return lags + 1 sums; the same bits for any number of threads
/// \throws Cancelled
LagSums lag_sums(Raster<float> const& dem, double datum, Axis axis, std::int64_t lags, Run const& run = {});

/// Differentiates a weighted total of lag sums by every height.
/// \param dem [m] by cell; NaN: no data
/// \param datum [m] subtracted from all heights
/// \param axis rows or columns
/// \param weights by lag 1, 2, ...
/// \param run progress, log, stop token and number of threads
/// \return by cell: the sum over k of weight k times the heights, minus the datum, k cells before and after; 0: no data
/// \throws Cancelled
Raster<double> weigh_lags(Raster<float> const& dem, double datum, Axis axis, std::vector<double> const& weights,
                          Run const& run = {});

} // namespace thalweg::solver
