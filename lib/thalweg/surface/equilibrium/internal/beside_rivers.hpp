// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <thalweg/surface/equilibrium/internal/land_level.hpp>

/// Private to this module.
namespace thalweg::surface {

/// Height of the highest river cell beside an inner cell, minus infinity without one.
inline float highest_river(LandLevel const& level, std::size_t i, std::array<std::int64_t, 8> const& offsets) {
    float highest = -std::numeric_limits<float>::infinity();
    for (std::int64_t const offset : offsets) {
        if (std::size_t const n = moved(i, offset); level.cover[n] == Cover::river) {
            highest = std::max(highest, level.z[n]);
        }
    }
    return highest;
}

} // namespace thalweg::surface
