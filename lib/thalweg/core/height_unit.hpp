// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace thalweg {

/// The unit of heights in a file. Inside thalweg heights are in metres.
enum class HeightUnit : std::uint8_t {
    metre,
    foot ///< international
};

constexpr double metres_in(HeightUnit unit) {
    return unit == HeightUnit::foot ? 0.3048 : 1.0;
}

/// The name of a unit in files.
/// \param unit metre or foot
/// \return "m" or "ft"
constexpr char const* name_of(HeightUnit unit) {
    return unit == HeightUnit::foot ? "ft" : "m";
}

} // namespace thalweg
