// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string_view>

namespace thalweg::measure {

/// What a law's figure is in nature, as far as it has been published.
struct NaturalRange {
    std::string_view law; ///< its key in report.json
    double low = 0.0;
    double high = 0.0;
    std::string_view source; ///< author, year, what was measured
};

/// One entry a law for which a range was published; a law without one has none here.
/// \return the published ranges
std::span<NaturalRange const> natural_ranges();

/// \param law name of the law
/// \return the range of a law, or null.
NaturalRange const* natural_range(std::string_view law);

} // namespace thalweg::measure
