// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include <thalweg/core/vec.hpp>

namespace thalweg {

/// What a check or a repair reports of one feature.
struct Finding {
    std::string kind;         ///< snake_case, e.g. "crossing", "uphill", "snapped"
    std::int64_t feature = 0; ///< id in the file or arc_id; 0: none
    Vec2 where;               ///< [m]
    double amount = 0.0;      ///< size of the fault, in the unit of its kind
    std::string text;         ///< one readable line
};

/// The direction of a limit.
enum class Bound : std::uint8_t { at_most, at_least };

constexpr char const* word_of(Bound bound) {
    return bound == Bound::at_least ? "at_least" : "at_most";
}

/// One entry of `checks` in report.json.
struct Check {
    std::string name;
    double value = 0.0;
    double limit = 0.0;
    bool ok = false;
    Bound bound = Bound::at_most;
};

} // namespace thalweg
