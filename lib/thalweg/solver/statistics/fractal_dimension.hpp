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

/// How much heights differ at a distance.
struct Difference {
    std::int64_t lag = 0; ///< [cells]
    double square = 0.0;  ///< [m2] mean squared difference, the average of both axes
    double pairs_along_row = 0.0;
    double pairs_along_column = 0.0;
};

/// Mean squared differences of heights at lags.
/// \pre a DEM, NaN where there is none.
/// \param dem [m] heights by cell; NaN: no data
/// \param lags [cells] the lags
/// \param run progress, log, stop token and number of threads
/// \return for each lag at which there are pairs the mean over rows and that over columns, averaged; where an axis has
/// no pairs the other's.
/// \throws Cancelled
std::vector<Difference> differences(Raster<float> const& dem, std::span<std::int64_t const> lags, Run const& run = {});

/// Fractal dimension D = 3 - H; H is the slope of the least-squares line of ln(square)/2 over ln(lag).
/// \param differences mean squared differences by lag
/// \return NaN with fewer than two lags, or where heights at one of them do not differ.
///
/// Source: \cite zhang, section 3.4.
double fractal_dimension(std::vector<Difference> const& differences);

/// \param differences mean squared differences by lag
/// \return derivatives of D by the squares.
std::vector<double> fractal_dimension_slopes(std::vector<Difference> const& differences);

} // namespace thalweg::solver
