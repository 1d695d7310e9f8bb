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

/// Correlation of heights at the lags 1, 2, ... along an axis.
struct Correlogram {
    std::vector<double> r;     ///< [-] NaN where no pair is
    std::vector<double> pairs; ///< how many pairs of cells r is the mean of
};

/// \pre a DEM, NaN where there is none; its mean and population deviation [m].
/// \param dem [m] heights by cell; NaN: no data
/// \param mean [m] mean height
/// \param std [m] standard deviation of the heights
/// \param axis columns or rows
/// \param run progress, log, stop token and number of threads
/// \return r at lag k is the mean of (z - mean)(z' - mean) over all pairs k cells apart, divided by std^2, for k = 1
/// ... half the cells along the axis. Empty where std is 0.
/// \throws Cancelled
Correlogram correlogram(Raster<float> const& dem, double mean, double std, Axis axis, Run const& run = {});

/// What correlation_length() returns.
struct CorrelationLength {
    double cells = std::numeric_limits<double>::quiet_NaN(); ///< [cells] NaN when the heights tell none
    bool extrapolated = false; ///< r does not fall to 1/e within half the extent: cells comes from a fit
};

/// Where the correlation falls to 1/e.
/// \param correlogram correlation by lag
/// \return the first crossing, linear between lags (r is 1 at lag 0); if there is none, L of the least-squares fit of
/// ln(-ln r) = alpha (ln k - ln L) to the lags with 0 < r < 1.
///
/// Source: \cite zhang, section 2.
CorrelationLength correlation_length(Correlogram const& correlogram);

/// \param correlogram correlation by lag
/// \return derivatives of ln L by r at the lags 1, 2, ...; empty where there is no L.
std::vector<double> correlation_length_slopes(Correlogram const& correlogram);

} // namespace thalweg::solver
