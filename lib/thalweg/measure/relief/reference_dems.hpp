// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <string_view>

#include <thalweg/measure/relief/relief_metrics.hpp>

namespace thalweg::measure {

inline constexpr std::size_t slope_share_count = 45;

/// What relief() finds in the DEM of a reference DEM.
struct ReferenceDem {
    std::string_view name;
    std::string_view file; ///< in samples/, where PROVENANCE.md names its source
    std::string_view source;
    double cell_m = 0.0;
    std::array<double, relief_metric_count> figures{}; ///< as relief_metrics
    std::array<double, slope_share_count> slopes{};    ///< [0,1] shares of 2 degrees each
    std::array<double, form_count> forms{};            ///< [0,1] shares of the geomorphons
    std::span<AreaBin const> slope_area;
};

/// The lands beside which others are shown: a steep, dissected range, and a plateau with dendritic and trellis valleys.
/// \return the reference DEMs
std::span<ReferenceDem const> reference_dems();

/// \return Shares of geomorphons, the mean of the reference DEMs.
std::array<double, form_count> mean_forms();

/// How far a figure of a land may be from those of reference DEM.
struct ReliefRange {
    double low = 0.0;
    double high = 0.0;
};

inline constexpr double land_tolerance = 1.25; ///< two lands are not all

/// \param figure place of the metric in relief_metrics()
/// \return from the lesser of the reference DEMs' figures over land_tolerance to the greater times it.
ReliefRange relief_range(std::size_t figure);

} // namespace thalweg::measure
