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

constexpr float least_width = 0.5F; // [cells]: what is narrower shows as nothing
constexpr float foot_widths = 2.0F; // where the foot ends, of the floor's half width
constexpr float most_widening = 2.0F;
constexpr float floor_share = 0.04F; // of the cap, on the floor

/// Floors are nowhere ribbons of one width: from half of it in gorges to twice in basins.
float widening(LandLevel const& level, std::size_t i, FloorParams const& params) {
    double const long_wave = std::max(2.0, 1800.0 / params.cell_m); // [cells]
    double const short_wave = std::max(2.0, 400.0 / params.cell_m);
    Cell const cell{static_cast<std::int64_t>(i) % level.width, static_cast<std::int64_t>(i) / level.width};
    double const noise = value_noise(params.seed, cell, long_wave) + 0.5 * value_noise(params.seed, cell, short_wave);
    return static_cast<float>(portable::exp(std::clamp(noise, -1.0, 1.0) * 0.69));
}

/// By how much floors of river cells are wider near the sea, which has drowned and filled their mouths.
std::vector<float> filled_mouths(LandLevel const& level, double cell_m) {
    constexpr double reach_m = 3000.0;
    constexpr float at_mouth = 2.1F;
    RiverCells const& rivers = level.rivers;
    auto const offsets = level.offsets();
    std::vector<float> more(rivers.cell.size());
    auto const kept = static_cast<float>(portable::exp(-cell_m / reach_m));
    for (std::size_t n = 0; n < more.size(); ++n) {
        if (rivers.receiver[n] >= 0) {
            more[n] = kept * more[static_cast<std::size_t>(rivers.receiver[n])];
        } else if (std::any_of(offsets.begin(), offsets.end(), [&](std::int64_t offset) {
                       return level.cover[moved(rivers.cell[n], offset)] == Cover::sea;
                   })) {
            more[n] = at_mouth;
        }
    }
    return more;
}

/// Width of a floor over that where 1 km² drains. Beyond, rivers of a range run between its flanks.
double growth(double area_km2) {
    constexpr double confined_km2 = 200.0;
    return portable::pow(std::min(area_km2, confined_km2), 0.42);
}

/// [cells] half widths of the floors of river cells.
std::vector<float> half_widths(LandLevel const& level, FloorParams const& params) {
    double const per_cell_km2 = params.cell_m * params.cell_m * 1e-6;
    double const per_km = 1000.0 / params.cell_m * params.width_km;
    std::vector<float> widths = filled_mouths(level, params.cell_m);
    for (std::size_t n = 0; n < widths.size(); ++n) {
        double const area_km2 = static_cast<double>(level.area[level.rivers.cell[n]]) * per_cell_km2;
        widths[n] = (1.0F + widths[n]) * static_cast<float>(per_km * growth(area_km2));
    }
    return widths;
}

} // namespace

void valley_floors(LandLevel& level, FloorParams const& params) {
    std::vector<float> const widths = half_widths(level, params);
    std::vector<float> reach(widths.size());
    std::transform(widths.begin(), widths.end(), reach.begin(),
                   [](float width) { return most_widening * foot_widths * width; });
    NearestRiver near = nearest_river(level, reach, std::move(level.order));
    each_inner(level, [&](std::size_t i) {
        if (near.distance[i] >= 0.0F || !is_land(level.cover[i])) {
            return;
        }
        float const width = widths[near.number[i]];
        if (width < least_width) {
            return;
        }
        float const far = (near.distance[i] / width + most_widening * foot_widths) / widening(level, i, params);
        float const up = std::clamp((far - 1.0F) / (foot_widths - 1.0F), 0.0F, 1.0F);
        level.cap[i] *= floor_share + (1.0F - floor_share) * up * up;
    });
    level.order = std::move(near.number);
}

} // namespace thalweg::surface
