// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/graded_rivers.hpp>

#include <thalweg/surface/equilibrium/internal/second_ring.hpp>

#include <algorithm>
#include <limits>

namespace thalweg::surface {

namespace {

constexpr float creep_brings = 1.15F; // what rivers carry besides what is lifted under them, as other valleys do
// Of the cap: two steps by corners must rise by less than land of the mean slope does in one by a side.
constexpr float share_of_cap = 0.3F;
constexpr float above_land = 0.02F;  // [cells of the level] that a river may stand above the land two cells away
constexpr float above_river = 0.25F; // [cells of the level] and above another river there
constexpr float kept_share = 0.3F;   // of its fall, which a reach keeps when it is lowered for what lies upstream
constexpr std::uint32_t great = 16;  // times the area of a brook: no river is lowered for it

/// The greatest height of a river cell that does not leave it perched: by the second ring of cells around it.
float height_by_ring(LandLevel const& level, std::uint32_t cell) {
    float most = std::numeric_limits<float>::infinity();
    each_of_second_ring(level, cell, [&](std::size_t n) {
        bool const land = level.cover[n] == Cover::land || level.cover[n] == Cover::rim;
        most = std::min(most, level.z[n] + (land ? above_land : above_river) * level.side);
    });
    return most;
}

} // namespace

float graded_tangent(LandLevel const& level, EquilibriumLaw const& law, std::uint32_t i) {
    float const area = static_cast<float>(level.area[i]) * level.side * level.side + law.source_area;
    float const uplift = level.uplift.empty() ? 1.0F : level.uplift[i];
    float const graded = creep_brings * uplift / (level.erodibility[i] * law.power(area));
    return std::min(graded, share_of_cap * std::min(level.cap[i], steepest_tangent));
}

std::vector<float> greatest_heights(LandLevel const& level, EquilibriumLaw const& law) {
    RiverCells const& rivers = level.rivers;
    std::vector<float> most(rivers.cell.size());
    std::transform(rivers.cell.begin(), rivers.cell.end(), most.begin(),
                   [&](std::uint32_t i) { return height_by_ring(level, i); });
    std::vector<std::uint32_t> area(most.size()); // of the cell for which one is lowered
    std::transform(rivers.cell.begin(), rivers.cell.end(), area.begin(),
                   [&](std::uint32_t i) { return level.area[i]; });
    for (std::size_t n = most.size(); n-- > 0;) {
        if (rivers.receiver[n] < 0) {
            continue;
        }
        auto const r = static_cast<std::size_t>(rivers.receiver[n]);
        float const fall = graded_tangent(level, law, rivers.cell[n]) * level.side *
                           step_lengths[static_cast<std::size_t>(rivers.way[n])];
        float const below = most[n] - kept_share * fall;
        if (below < most[r] && level.area[rivers.cell[r]] / great <= area[n]) {
            most[r] = below;
            area[r] = area[n];
        }
    }
    return most;
}

} // namespace thalweg::surface
