// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::solver {

/// Along rows (to the east) or along columns (to the south).
enum class Axis { rows, columns };

/// Sums over all pairs of cells that lie 0, 1, ... cells apart along an axis.
struct LagSums {
    std::vector<double> products; ///< [m2] of the two heights less the datum
    std::vector<double> pairs;    ///< how many pairs both of whose cells have heights
};

/// \pre a DEM, NaN where there is none; a datum [m]; how many lags beyond 0, fewer than there are cells along the axis.
/// \param dem [m] heights by cell; NaN: no data
/// \param datum [m] subtracted from all heights
/// \param axis columns or rows
/// \param lags number of lags beyond 0
/// \param run progress, log, stop token and number of threads
/// \return sums of lags + 1 numbers, by transforms of single rows or columns: O(cells log), memory for a few of those.
/// The same bits for any number of threads.
/// \throws Cancelled
LagSums lag_sums(Raster<float> const& dem, double datum, Axis axis, std::int64_t lags, Run const& run = {});

/// Heights weighted by their distance along an axis, the derivative of weighted lag sums.
/// \pre as lag_sums; weights of the lags 1, 2, ... at indices 0, 1, ....
/// \param dem [m] heights by cell; NaN: no data
/// \param datum [m] subtracted from all heights
/// \param axis columns or rows
/// \param weights the weights
/// \param run progress, log, stop token and number of threads
/// \return in each cell with a height the sum over k of weight k times the heights less the datum k cells before and
/// behind it that exist; 0 in cells without.
/// \throws Cancelled
Raster<double> weigh_lags(Raster<float> const& dem, double datum, Axis axis, std::vector<double> const& weights,
                          Run const& run = {});

} // namespace thalweg::solver
