// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/valley_floors.hpp>

#include <thalweg/core/elementary.hpp>
#include <thalweg/surface/nearest_river.hpp>

#include <utility>
#include <vector>

namespace thalweg::surface {

namespace {

constexpr double growth = 0.4;
constexpr float least_width = 0.5F; // [cells]: what is narrower shows as nothing
constexpr float flat_share = 0.15F; // of the cap, on the floor

} // namespace

void valley_floors(LandLevel& level, double floor_width) {
    RiverCells const& rivers = level.rivers;
    std::vector<float> widths(rivers.cell.size());
    std::vector<float> reach(widths.size());
    for (std::size_t n = 0; n < widths.size(); ++n) {
        widths[n] = static_cast<float>(floor_width * exact::pow(level.area[rivers.cell[n]], growth));
        reach[n] = 2.0F * widths[n];
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
        float const up = near.distance[i] <= -width ? 0.0F : (near.distance[i] + width) / width;
        level.cap[i] *= flat_share + (1.0F - flat_share) * up;
    });
    level.order = std::move(near.number);
}

} // namespace thalweg::surface
