// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \cpponly

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/spectral/circulant.hpp>

// Idea: The numbers that describe terrain in Zhang, Liu and Li, and how each answers to every
// height. Correlation at all lags along an axis comes from the squared spectrum of each row (Wiener
// and Khinchin), padded so that nothing wraps round; the length is where it falls to 1/e, the
// dimension the slope of log differences over log lags. The derivative of each by each height is a
// raster, by the chain rule through lags and differences, which is what match_statistics needs to
// move terrain. with_slope gives a covariance a share of short waves until terrain drawn from it is
// as steep as asked.
// Source: Zhang, Liu and Li, section 2, section 3.4 and table 4; derivatives and fine forms are
// ours: docs/decisions/0008-projection.md.
// Cost: O(n log n) for n cells, with memory for some rows; derivatives likewise. All cores; sums in
// one order.
// Not for: slopes in degrees (measure/relief/): slope_rad takes cells as 1 wide, as the paper does.
// A length beyond half the grid is extrapolated (`extrapolated`).
// Example:
//     FieldStatistics const is = field_statistics(dem);
//     Raster<double> const by_height = derivative(dem, is, Quantity::ln_lx);
// More: docs/statistics.md, "What the numbers mean".

namespace thalweg::solver {

/// Differentiates heights along an axis: central, one-sided beside a hole (NaN), 0 between two holes.
/// \param before [m] height of the previous cell
/// \param here [m] height of the cell
/// \param after [m] height of the next cell
/// \return [m] per cell
inline double central_difference(float before, float here, float after) {
    double const z = here;
    // All computed, then one chosen: loops over cells need no branch.
    double const left = z - before;
    double const right = after - z;
    double const both = (static_cast<double>(after) - before) / 2.0;
    double const without_left = std::isnan(after) ? 0.0 : right;
    double const with_left = std::isnan(after) ? left : both;
    return std::isnan(before) ? without_left : with_left;
}

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
/// \return lags + 1 sums; the same bits for any number of threads
LagSums lag_sums(Raster<float> const& dem, double datum, Axis axis, std::int64_t lags, Run const& run = {});

/// Differentiates a weighted total of lag sums by every height.
/// \param dem [m] by cell; NaN: no data
/// \param datum [m] subtracted from all heights
/// \param axis rows or columns
/// \param weights by lag 1, 2, ...
/// \return by cell: the sum over k of weight k times the heights, minus the datum, k cells before and after; 0: no data
Raster<double> weigh_lags(Raster<float> const& dem, double datum, Axis axis, std::vector<double> const& weights,
                          Run const& run = {});

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
/// \return by lag k = 1 ... half the cells along the axis: the mean of (z - mean)(z' - mean) / std^2 over all pairs k
/// cells apart; empty for std = 0
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
/// \return for each lag with pairs: the average of the means over rows and columns, or the only one with pairs
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
/// \return as measure::statistics
///
/// Source: \cite zhang, table 4.
FieldStatistics field_statistics(Raster<float> const& dem, Run const& run = {});

/// A statistic to differentiate; correlation lengths by their logarithms.
enum class Quantity { mean, std, ln_lx, ln_ly, slope_rad, dimension };

/// Differentiates a statistic by every height.
/// \param dem [m] by cell; NaN: no data
/// \param is field_statistics of the DEM
/// \param quantity one that is a number there
/// \return by cell; 0: no data, and for the slope also level cells. The same bits for any number of threads.
Raster<double> derivative(Raster<float> const& dem, FieldStatistics const& is, Quantity quantity, Run const& run = {});

/// Computes the mean slope of Gaussian terrain with a covariance.
/// \param covariance correlation by distance
/// \param std [m] standard deviation of the heights
/// \return [rad] expectation of arctan |grad z| with z in metres, central differences and a spacing of one cell, to
/// about 0.001
double expected_slope(StableCovariance const& covariance, double std);

/// Adds fine forms to a covariance until its terrain has a given mean slope. Reference DEMs need it: they are far
/// steeper than a power law from lags 1 to 5 to the correlation length.
/// \param covariance without fine forms
/// \param std [m] standard deviation of the heights
/// \param slope_rad [rad] (0, pi/2) mean slope
/// \return with the same correlation lengths, and longer coarse forms; unchanged if already steep enough; at most half
/// of the variance is fine
StableCovariance with_slope(StableCovariance covariance, double std, double slope_rad);

} // namespace thalweg::solver
