// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cstdint>

/// Private to this module.
namespace thalweg::flow {

/// [m] what water needs to run, at least: about a unit in the last place of a float at 200 m. Near 0, where such units
/// vanish, no reader of a DEM would see less.
inline constexpr float small_step = 0x1p-16F;

/// The least height above z that counts.
inline float just_above(float z) {
    float const above = z + small_step;
    if (above > z) {
        return above;
    }
    auto const bits = std::bit_cast<std::uint32_t>(z);
    return std::bit_cast<float>(z > 0.0F ? bits + 1 : bits - 1);
}

/// The greatest height below z that counts.
inline float just_below(float z) {
    return -just_above(-z);
}

} // namespace thalweg::flow
