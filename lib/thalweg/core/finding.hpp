// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include <thalweg/core/vec.hpp>

namespace thalweg {

/// Something a check or a repair has to say about one feature.
struct Finding {
    std::string kind;         ///< snake_case, e.g. "crossing", "uphill", "snapped"
    std::int64_t feature = 0; ///< id in the file or arc_id; 0 when it concerns none
    Vec2 where;               ///< [m]
    double amount = 0.0;      ///< how much, in the unit of the kind
    std::string text;         ///< one readable line
};

/// On which side of its limit a value passes.
enum class Bound : std::uint8_t { at_most, at_least };

constexpr char const* word_of(Bound bound) {
    return bound == Bound::at_least ? "at_least" : "at_most";
}

/// One line of report.json's checks.
struct Check {
    std::string name;
    double value = 0.0;
    double limit = 0.0;
    bool ok = false;
    Bound bound = Bound::at_most;
};

} // namespace thalweg
