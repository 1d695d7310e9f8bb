// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace thalweg::measure {

/// Finds a percentile of values that are counted by class, with values spread evenly within a class.
/// \param counts by class
/// \param wanted [0, values] number of values that lie below it
/// \return [classes] from the lower end of the first; NaN: no values
inline double place_in_classes(std::span<std::int64_t const> counts, double wanted) {
    double before = 0.0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        auto const here = static_cast<double>(counts[i]);
        if (here > 0.0 && before + here >= wanted) {
            return static_cast<double>(i) + (wanted - before) / here;
        }
        before += here;
    }
    return std::numeric_limits<double>::quiet_NaN();
}

} // namespace thalweg::measure
