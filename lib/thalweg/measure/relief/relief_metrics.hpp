// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include <thalweg/measure/relief/relief.hpp>

namespace thalweg::measure {

/// Whether a metric distinguishes terrain from noise in any region.
enum class Judges : std::uint8_t { yes, large_values, no };

/// One index of Relief.
struct ReliefMetric {
    std::string_view key; ///< in report.json
    std::string_view name;
    std::string_view unit;
    Judges judges = Judges::yes;           ///< no: it depends on the extent or on the survey of heights
    double (*of)(Relief const&) = nullptr; ///< NaN: unknown
    double tolerance = 1.25;               ///< [1, ...] margin around the reference DEMs: two are not all terrain
};

inline constexpr std::size_t relief_metric_count = 30;

/// The metrics compared with reference DEMs.
/// \return in a fixed order
std::array<ReliefMetric, relief_metric_count> const& relief_metrics();

} // namespace thalweg::measure
