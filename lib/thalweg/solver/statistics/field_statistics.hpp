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

/// The statistics a land can be made to have, with what their derivatives are computed from.
struct FieldStatistics {
    std::int64_t cells = 0; ///< cells with heights
    double mean = 0.0;      ///< [m]
    double std = 0.0;       ///< [m] population
    CorrelationLength lx;   ///< along rows
    CorrelationLength ly;   ///< along columns
    double slope_rad = 0.0; ///< [rad] mean of arctan |grad z| with z in metres and a spacing of one cell
    double dimension = 0.0; ///< fractal dimension from lags 1 to 5; NaN when the heights tell none

    Correlogram along_row;
    Correlogram along_column;
    std::vector<Difference> differences;
};

/// \param dem a DEM, NaN where there is none; at least one height
/// \param run progress, log, stop token and number of threads
/// \return the statistics by the same definitions as measure::statistics.
/// \throws Cancelled
///
/// Source: \cite zhang, table 4.
FieldStatistics field_statistics(Raster<float> const& dem, Run const& run = {});

/// Which statistic is derived: the lengths by their logarithms.
enum class Quantity { mean, std, ln_lx, ln_ly, slope_rad, dimension };

/// How a statistic answers to every height.
/// \pre a DEM and its field_statistics; the statistic is a number.
/// \param dem [m] heights by cell; NaN: no data
/// \param is the DEM's statistics
/// \param quantity a statistic
/// \param run progress, log, stop token and number of threads
/// \return the derivative by the height of each cell, 0 in cells without; level places count as answering to none in
/// the slope. The same bits for any number of threads.
/// \throws Cancelled
Raster<double> derivative(Raster<float> const& dem, FieldStatistics const& is, Quantity quantity, Run const& run = {});

} // namespace thalweg::solver
