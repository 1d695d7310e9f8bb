// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::solver {

inline constexpr std::array<std::int64_t, 5> near_lags = {1, 2, 3, 4, 5};
inline constexpr std::array<std::int64_t, 6> dyadic_lags = {1, 2, 4, 8, 16, 32};

/// The mean squared difference of heights at a lag.
struct Difference {
    std::int64_t lag = 0; ///< [cells]
    double square = 0.0;  ///< [m2] average of both axes
    double pairs_along_row = 0.0;
    double pairs_along_column = 0.0;
};

/// Computes mean squared differences of heights.
/// \param dem [m] by cell; NaN: no data
/// \param lags [cells]
/// \param run progress, log, stop token and number of threads
/// \return for each lag with pairs: the average of the means over rows and columns, or the only one with pairs
/// \throws Cancelled
std::vector<Difference> differences(Raster<float> const& dem, std::span<std::int64_t const> lags, Run const& run = {});

/// Computes the fractal dimension D = 3 - H; H is the slope of the least-squares line of ln(square)/2 over ln(lag).
/// \param differences mean squared differences by lag
/// \return NaN with fewer than two lags, or where a difference is 0
///
/// Source: \cite zhang, section 3.4.
double fractal_dimension(std::vector<Difference> const& differences);

/// Differentiates the fractal dimension by the squares.
/// \param differences mean squared differences by lag
/// \return by lag
std::vector<double> fractal_dimension_slopes(std::vector<Difference> const& differences);

} // namespace thalweg::solver
