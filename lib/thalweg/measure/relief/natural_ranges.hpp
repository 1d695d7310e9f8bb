// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string_view>

namespace thalweg::measure {

/// The published natural range of a law's metric.
struct NaturalRange {
    std::string_view law; ///< its key in report.json
    double low = 0.0;
    double high = 0.0;
    std::string_view source; ///< author, year, what was measured
};

/// The natural ranges of all laws for which one is published.
/// \return one entry per law
std::span<NaturalRange const> natural_ranges();

/// Finds the natural range of a law.
/// \param law its key in report.json
/// \return null: none is published
NaturalRange const* natural_range(std::string_view law);

} // namespace thalweg::measure
