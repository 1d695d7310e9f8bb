// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <thalweg/measure/laws/line_fit.hpp>

namespace thalweg::measure {

/// What was measured of a place that drains an area.
struct AtArea {
    double area_m2 = 0.0;
    double value = 0.0;
};

/// Places that drain like areas.
struct AreaBin {
    double area_m2 = 0.0; ///< geometric mean
    double value = 0.0;   ///< likewise
    std::int64_t places = 0;
};

/// value = coefficient * area^exponent, area in m2.
struct PowerLaw {
    double exponent = 0.0;
    double coefficient = 0.0;
    double r2 = 0.0;             ///< of the line through the bins' logarithms; NaN where all have one value
    double exponent_error = 0.0; ///< standard error, of the same line
    std::vector<AreaBin> bins;   ///< by area
    std::int64_t places = 0;     ///< in the bins
    std::int64_t left_out = 0;   ///< without a logarithm, or in bins of too few
};

/// \param law the law
/// \param fit the fitted line
/// \param least_bins least number of bins
/// \return a law whose bins are there and whose numbers come from the line through their logarithms; nothing where
/// there is no line, or one through fewer than least_bins points.
std::optional<PowerLaw> with_line(PowerLaw law, std::optional<LineFit> const& fit, std::int64_t least_bins);

/// Options of fit_power_law().
struct PowerLawParams {
    int bins_per_decade = 4;       ///< [1, 100] of area
    std::int64_t least_places = 3; ///< [1, ...] a bin with fewer is left out
    std::int64_t least_bins = 3;   ///< [2, ...] below there is no law
};

/// The power of area by which something changes, on logarithmic bins of area.
/// \param places the places
/// \param params options, each with its default, unit and range
/// \return the line of least squares through the means of the logarithms in bins of equal width, every bin counting
/// once: small areas, of which there are most, do not outvote large ones. Places whose area or value is not above 0
/// have no logarithm and are counted as left out. An exact power law is recovered exactly, up to rounding.
/// \throws BadParameter
///
/// Source: \cite tarboton1991 (bins of area).
std::optional<PowerLaw> fit_power_law(std::vector<AtArea> const& places, PowerLawParams const& params = {});

} // namespace thalweg::measure
