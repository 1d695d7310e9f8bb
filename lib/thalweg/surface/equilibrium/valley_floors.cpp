// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/valley_floors.hpp>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/value_noise.hpp>
#include <thalweg/surface/equilibrium/internal/nearest_river.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace thalweg::surface {

namespace {

constexpr double growth = 0.4;
constexpr float least_width = 0.5F;  // [cells]: what is narrower shows as nothing
constexpr float core_widths = 0.4F;  // what is flat, and
constexpr float reach_widths = 2.7F; // where the foot ends, both before they are narrowed
constexpr float floor_share = 0.15F; // of the cap, on the floor

/// Floors are nowhere ribbons of one width: about 1.5, and 1 at least.
float narrowing(LandLevel const& level, std::size_t i, std::uint64_t seed) {
    constexpr double long_wave = 48.0; // [cells]
    constexpr double short_wave = 13.0;
    Cell const cell{static_cast<std::int64_t>(i) % level.width, static_cast<std::int64_t>(i) / level.width};
    double const noise = value_noise(seed, cell, long_wave) + 0.5 * value_noise(seed, cell, short_wave);
    return static_cast<float>(std::max(1.0, 1.5 + 0.7 * noise));
}

} // namespace

void valley_floors(LandLevel& level, double floor_width, std::uint64_t seed) {
    RiverCells const& rivers = level.rivers;
    std::vector<float> widths(rivers.cell.size());
    std::vector<float> reach(widths.size());
    for (std::size_t n = 0; n < widths.size(); ++n) {
        widths[n] = static_cast<float>(floor_width * portable::pow(level.area[rivers.cell[n]], growth));
        reach[n] = reach_widths * widths[n];
    }
    NearestRiver near = nearest_river(level, reach, std::move(level.order));
    each_inner(level, [&](std::size_t i) {
        if (near.distance[i] >= 0.0F || !is_land(level.cover[i])) {
            return;
        }
        float const width = widths[near.number[i]];
        if (width < least_width) {
            return;
        }
        float const far = (near.distance[i] / width + reach_widths) * narrowing(level, i, seed); // in widths
        float const up = std::max(0.0F, (far - core_widths) / (reach_widths - core_widths));
        level.cap[i] *= floor_share + (1.0F - floor_share) * up * std::sqrt(up);
    });
    level.order = std::move(near.number);
}

} // namespace thalweg::surface
