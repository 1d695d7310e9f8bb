// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <thalweg/core/vec.hpp>

// Idea: A power law is a straight line through logarithms. Small areas are by far the most
// frequent, so that a fit through all places would describe them alone. Places are therefore
// gathered in bins of equal width of log area; each bin with enough places gives one point, the
// mean of its logarithms, and all bins count alike.
// Source: Tarboton et al. 1991 (bins of area).
// Cost: O(places log bins). One thread.
// Not for: deciding whether a power law holds at all: r2 of a few bins is high for many curves.
// Slopes of single cells, whose logarithm does not exist where the DEM is level: slope_area
// (measure/relief/slope_area.hpp) adds drops and lengths up first.
// Example:
//     std::vector<AtArea> const places = {{1e4, 100.0}, {1e5, 400.0}, {1e6, 1600.0}};
//     if (auto const law = fit_power_law(places, {.least_places = 1})) {
//         double const hack_exponent = law->exponent;
//     }
// More: docs/relief_measures.md, "Methods".

namespace thalweg::measure {

/// A least-squares line.
struct LineFit {
    double slope = 0.0;     ///< [y / x]
    double intercept = 0.0; ///< [y] at x = 0
    /// share of y's variance explained; NaN: two points, or y is constant
    double r2 = std::numeric_limits<double>::quiet_NaN();
    double slope_error = std::numeric_limits<double>::quiet_NaN(); ///< [y / x] standard error; NaN: two points
    std::int64_t points = 0;
};

/// Fits a line by least squares.
/// \param points x and y
/// \param weights > 0, one per point; empty: equal
/// \return nothing for fewer than two different x
std::optional<LineFit> fit_line(std::vector<Vec2> const& points, std::vector<double> const& weights = {});

/// A value at a place, and the area that drains to it.
struct AtArea {
    double area_m2 = 0.0;
    double value = 0.0; ///< [any]
};

/// The mean of places with similar areas.
struct AreaBin {
    double area_m2 = 0.0; ///< geometric mean
    double value = 0.0;   ///< [any] geometric mean
    std::int64_t places = 0;
};

/// A power law of area: value = coefficient * area^exponent, area in m2.
struct PowerLaw {
    double exponent = 0.0;
    double coefficient = 0.0;    ///< [value / m^(2 exponent)]
    double r2 = 0.0;             ///< of the regression of the bins' logarithms; NaN: all values are equal
    double exponent_error = 0.0; ///< standard error
    std::vector<AreaBin> bins;   ///< by area
    std::int64_t places = 0;     ///< in the bins
    std::int64_t left_out = 0;   ///< without a logarithm, or in bins with too few places
};

/// Completes a power law from the regression of its bins.
/// \param law with its bins
/// \param fit the line through the bins' logarithms, if any
/// \param least_bins [2, ...] minimum number of bins
/// \return nothing without a line or with fewer bins
std::optional<PowerLaw> with_line(PowerLaw law, std::optional<LineFit> const& fit, std::int64_t least_bins);

/// Options of fit_power_law().
struct PowerLawParams {
    int bins_per_decade = 4;       ///< [1, 100] of area
    std::int64_t least_places = 3; ///< [1, ...] minimum number of places in a bin
    std::int64_t least_bins = 3;   ///< [2, ...] below there is no law
};

/// Fits a power law of area by least squares through the mean logarithms of bins of equal logarithmic width, all with
/// equal weight: small areas, the most frequent, do not dominate.
/// \param places areas and values; those not above 0 are counted as left out
/// \return recovers an exact power law up to rounding; nothing with fewer than least_bins bins
/// \throws BadParameter when a parameter is outside its range
///
/// Source: \cite tarboton1991 (bins of area).
std::optional<PowerLaw> fit_power_law(std::vector<AtArea> const& places, PowerLawParams const& params = {});

} // namespace thalweg::measure
