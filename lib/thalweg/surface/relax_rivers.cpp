// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/relax_rivers.hpp>

#include <algorithm>
#include <limits>

namespace thalweg::surface {

namespace {

constexpr float source_area = 200.0F; // [finest cells]: a drawn source drains something already
constexpr float share_of_cap = 0.7F;
constexpr float perch = 0.02F; // [cells of the level]

/// The lowest land two cells away, or infinity.
float second_ring(LandLevel const& level, std::uint32_t cell) {
    float low = std::numeric_limits<float>::infinity();
    std::int64_t const col = cell % level.width;
    std::int64_t const row = cell / level.width;
    if (col < 2 || row < 2 || col + 2 >= level.width || row + 2 >= level.height) {
        return low;
    }
    auto const take = [&](std::int64_t east, std::int64_t south) {
        std::size_t const n = moved(cell, south * level.width + east);
        if (level.cover[n] == Cover::land || level.cover[n] == Cover::rim) {
            low = std::min(low, level.z[n]);
        }
    };
    for (std::int64_t d = -2; d <= 2; ++d) {
        take(d, -2);
        take(d, 2);
        take(-2, d);
        take(2, d);
    }
    return low;
}

} // namespace

void relax_rivers(LandLevel& level, EquilibriumLaw const& law) {
    RiverCells const& rivers = level.rivers;
    float const side = level.side;
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        if (rivers.receiver[n] < 0) {
            continue; // an end keeps its height
        }
        std::uint32_t const i = rivers.cell[n];
        float const below = level.z[rivers.cell[static_cast<std::size_t>(rivers.receiver[n])]];
        if (rivers.level[n] != 0) {
            level.z[i] = below;
            continue;
        }
        float const length = side * step_lengths[static_cast<std::size_t>(rivers.way[n])];
        float const area = static_cast<float>(level.area[i]) * side * side + source_area;
        float const uplift = level.uplift.empty() ? 1.0F : level.uplift[i];
        float const graded = uplift / (level.erodibility[i] * law.power(area));
        float const tangent = std::min(graded, share_of_cap * std::min(level.cap[i], steepest_tangent));
        float const z = std::min(below + tangent * length, second_ring(level, i) + perch * side);
        level.z[i] = std::max(z, below + least_tangent * length);
    }
}

} // namespace thalweg::surface
