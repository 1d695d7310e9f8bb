// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace thalweg {

/// What heights in a file count. Inside thalweg they are metres.
enum class HeightUnit : std::uint8_t {
    metre,
    foot ///< international
};

constexpr double metres_in(HeightUnit unit) {
    return unit == HeightUnit::foot ? 0.3048 : 1.0;
}

/// \param unit the unit
/// \return "m" or "ft", as in files.
constexpr char const* name_of(HeightUnit unit) {
    return unit == HeightUnit::foot ? "ft" : "m";
}

} // namespace thalweg
