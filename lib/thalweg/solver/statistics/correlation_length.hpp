// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/statistics/lags.hpp>

namespace thalweg::solver {

/// The correlation of heights along an axis, by lag 1, 2, ...
struct Correlogram {
    std::vector<double> r;     ///< [-] NaN: no pairs
    std::vector<double> pairs; ///< number of pairs
};

/// Computes the correlation of heights along an axis.
/// \param dem [m] by cell; NaN: no data
/// \param mean [m] mean of the heights
/// \param std [m] their population standard deviation
/// \param axis rows or columns
/// \param run progress, log, stop token and number of threads
/// \return by lag k = 1 ... half the cells along the axis: the mean of (z - mean)(z' - mean) / std^2 over all pairs k
/// cells apart; empty for std = 0
/// \throws Cancelled
Correlogram correlogram(Raster<float> const& dem, double mean, double std, Axis axis, Run const& run = {});

/// What correlation_length() returns.
struct CorrelationLength {
    double cells = std::numeric_limits<double>::quiet_NaN(); ///< [cells] NaN: undefined
    bool extrapolated = false; ///< r stays above 1/e within half the extent: cells is from a fit
};

/// Finds the lag at which the correlation falls to 1/e.
/// \param correlogram correlation by lag
/// \return the first crossing, linear between lags (r is 1 at lag 0); if there is none, L of the least-squares fit of
/// ln(-ln r) = alpha (ln k - ln L) to the lags with 0 < r < 1
///
/// Source: \cite zhang, section 2.
CorrelationLength correlation_length(Correlogram const& correlogram);

/// Differentiates ln L, the logarithm of the correlation length, by the correlations.
/// \param correlogram correlation by lag
/// \return by lag 1, 2, ...; empty: L is undefined
std::vector<double> correlation_length_slopes(Correlogram const& correlogram);

} // namespace thalweg::solver
