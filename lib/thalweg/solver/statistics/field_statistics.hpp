// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/statistics/correlation_length.hpp>
#include <thalweg/solver/statistics/fractal_dimension.hpp>

namespace thalweg::solver {

/// The statistics that terrain can be matched to, with what their derivatives need.
struct FieldStatistics {
    std::int64_t cells = 0; ///< cells with heights
    double mean = 0.0;      ///< [m]
    double std = 0.0;       ///< [m] population standard deviation
    CorrelationLength lx;   ///< along rows
    CorrelationLength ly;   ///< along columns
    double slope_rad = 0.0; ///< [rad] mean of arctan |grad z| with z in metres and a spacing of one cell
    double dimension = 0.0; ///< fractal dimension from lags 1 to 5; NaN: undefined

    Correlogram along_row;
    Correlogram along_column;
    std::vector<Difference> differences;
};

/// Computes the statistics by the definitions of measure::statistics.
/// \param dem [m] by cell; NaN: no data; at least one height
/// \param run progress, log, stop token and number of threads
/// \return as measure::statistics
/// \throws Cancelled
///
/// Source: \cite zhang, table 4.
FieldStatistics field_statistics(Raster<float> const& dem, Run const& run = {});

/// A statistic to differentiate; correlation lengths by their logarithms.
enum class Quantity { mean, std, ln_lx, ln_ly, slope_rad, dimension };

/// Differentiates a statistic by every height.
/// \param dem [m] by cell; NaN: no data
/// \param is field_statistics of the DEM
/// \param quantity one that is a number there
/// \param run progress, log, stop token and number of threads
/// \return by cell; 0: no data, and for the slope also level cells. The same bits for any number of threads.
/// \throws Cancelled
Raster<double> derivative(Raster<float> const& dem, FieldStatistics const& is, Quantity quantity, Run const& run = {});

} // namespace thalweg::solver
