// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

// Idea: For a fractional Brownian surface the mean square of differences k cells apart is sigma^2
// k^(2H): a straight line of logarithms over logarithms, whose slope is 2H. Lags 1 to 4 along rows
// and columns are enough for what midpoint() needs, the behaviour just above a cell.
// Source: Zhang, Liu and Li, on fractal interpolation.
// Cost: O(n), eight differences a cell. Rows run on all cores, sums are in row order.
// Not for: terrain with a scale of its own (valley spacing): its line bends, and H is that of the
// shortest lags. The fractal dimension of statistics uses lags 1 to 5
// (solver/statistics/field_statistics.hpp). Whole metres and interpolated DEMs bias H at short
// lags.
// Example:
//     Fractal const of_dem = estimate_fractal(dem);
//     double const dimension = 3.0 - of_dem.hurst;

namespace thalweg::fractal {

/// Range of Hurst exponents that are estimated or accepted.
inline constexpr double least_hurst = 0.05;
inline constexpr double greatest_hurst = 0.95;

enum class Differences : std::uint8_t {
    squares, ///< mean squares: S(k) = sigma^2 k^(2H)
    absolute ///< mean absolute values, as of normal differences: E|dz| = sqrt(2/pi) sigma k^H
};

/// Options of estimate_fractal().
struct EstimateParams {
    Differences differences = Differences::squares;
    std::optional<double> hurst; ///< [0.05, 0.95] prescribed, so that only sigma is estimated; empty: estimated
};

/// A fractional Brownian surface, E (z(p) - z(q))^2 = sigma^2 |p - q|^(2H) with distances in cells.
struct Fractal {
    double hurst = 0.5;     ///< [0.05, 0.95] H; the fractal dimension is 3 - H
    double sigma = 0.0;     ///< [m] root mean square difference of two heights one cell apart
    int lags = 0;           ///< [0, 4] number of lags with a difference other than 0
    std::int64_t pairs = 0; ///< of cells, over all lags
};

/// Cells [col, col + width) x [row, row + height).
struct CellWindow {
    std::int64_t col = 0;
    std::int64_t row = 0;
    std::int64_t width = 0;
    std::int64_t height = 0;
};

/// Estimates H and sigma of a raster by the least-squares line of ln S(k) over ln k, k = 1 ... 4 cells; S(k) is the
/// average of its means along rows and columns, or the only one.
/// \param dem [m] by cell; NaN: no data, left out with its pairs
/// \return H clamped to [0.05, 0.95], then sigma at that H. From one lag: H = 0.5 (unless prescribed) and sigma; from
/// none, as of a flat raster: sigma = 0. The same bits for any number of threads.
/// \throws BadInput for an infinite height
/// \throws BadParameter when the prescribed H is outside its range
///
/// Source: \cite zhang, section on fractal interpolation (H and sigma of the initial grid).
Fractal estimate_fractal(Raster<float> const& dem, EstimateParams const& params = {}, Run const& run = {});

/// Estimates H and sigma from the pairs of cells inside a window.
/// \param dem [m] by cell; NaN: no data
/// \param window inside the raster
/// \return as for a whole raster
/// \throws BadInput when the window leaves the raster
Fractal estimate_fractal(Raster<float> const& dem, CellWindow const& window, EstimateParams const& params = {});

} // namespace thalweg::fractal
