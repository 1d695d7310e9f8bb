// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <thalweg/measure/laws/line_fit.hpp>

namespace thalweg::measure {

/// A value at a place, and the area that drains to it.
struct AtArea {
    double area_m2 = 0.0;
    double value = 0.0;
};

/// The mean of places with similar areas.
struct AreaBin {
    double area_m2 = 0.0; ///< geometric mean
    double value = 0.0;   ///< geometric mean
    std::int64_t places = 0;
};

/// A power law of area: value = coefficient * area^exponent, area in m2.
struct PowerLaw {
    double exponent = 0.0;
    double coefficient = 0.0;
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
/// \param params options, each with its default, unit and range
/// \return recovers an exact power law up to rounding; nothing with fewer than least_bins bins
/// \throws BadParameter when a parameter is outside its range
///
/// Source: \cite tarboton1991 (bins of area).
std::optional<PowerLaw> fit_power_law(std::vector<AtArea> const& places, PowerLawParams const& params = {});

} // namespace thalweg::measure
