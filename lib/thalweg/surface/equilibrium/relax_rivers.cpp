// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/relax_rivers.hpp>

#include <thalweg/surface/equilibrium/internal/graded_rivers.hpp>

#include <algorithm>
#include <vector>

namespace thalweg::surface {

void relax_rivers(LandLevel& level, EquilibriumLaw const& law) {
    RiverCells const& rivers = level.rivers;
    std::vector<float> const most = greatest_heights(level, law);
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
        float const length = level.side * step_lengths[static_cast<std::size_t>(rivers.way[n])];
        float const z = std::min(below + graded_tangent(level, law, i) * length, most[n]);
        level.z[i] = std::max(z, below + least_tangent * length);
    }
}

} // namespace thalweg::surface
