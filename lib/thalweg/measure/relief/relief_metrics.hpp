// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include <thalweg/measure/relief/relief.hpp>

namespace thalweg::measure {

/// Whether a metric tells terrain from noise in any region.
enum class Judges : std::uint8_t { yes, no };

/// One number of a Relief.
struct ReliefMetric {
    std::string_view key; ///< in report.json
    std::string_view name;
    std::string_view unit;
    Judges judges = Judges::yes;           ///< no: it follows the extent or how heights were taken
    double (*of)(Relief const&) = nullptr; ///< NaN where it is unknown
};

inline constexpr std::size_t relief_metric_count = 19;

/// \return the metrics compared with reference DEMs, always the same in the same order.
std::array<ReliefMetric, relief_metric_count> const& relief_metrics();

} // namespace thalweg::measure
