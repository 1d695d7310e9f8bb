// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <string_view>

#include <thalweg/measure/relief/relief_metrics.hpp>

namespace thalweg::measure {

inline constexpr std::size_t slope_share_count = 45;

/// The metrics that relief() computes for a reference DEM.
struct ReferenceDem {
    std::string_view name;
    std::string_view file; ///< in samples/, with its source in PROVENANCE.md
    std::string_view source;
    double cell_m = 0.0;
    std::array<double, relief_metric_count> figures{}; ///< in the order of relief_metrics
    std::array<double, slope_share_count> slopes{};    ///< [0, 1] shares of classes of 2 degrees
    std::array<double, form_count> forms{};            ///< [0, 1] shares of geomorphons
    std::span<AreaBin const> slope_area;
};

/// The reference DEMs: a steep, dissected range, and a plateau with dendritic and trellis valleys.
/// \return two entries
std::span<ReferenceDem const> reference_dems();

/// Averages the shares of geomorphons over the reference DEMs.
/// \return by form
std::array<double, form_count> mean_forms();

/// The plausible range of a metric, around the reference DEMs.
struct ReliefRange {
    double low = 0.0;
    double high = 0.0;
};

/// Computes the plausible range of a metric.
/// \param figure index in relief_metrics()
/// \return from the smaller reference value / tolerance to the larger * tolerance; from 0 where large values alone
/// judge
ReliefRange relief_range(std::size_t figure);

} // namespace thalweg::measure
