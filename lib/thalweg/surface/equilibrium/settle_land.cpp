// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/settle_land.hpp>

#include <thalweg/surface/equilibrium/internal/beside_rivers.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg::surface {

void settle_land(LandLevel& level, float step, RiverHeights heights) {
    auto const above = [step](float z) {
        return std::max(z + step, std::nextafter(z, std::numeric_limits<float>::infinity()));
    };
    RiverCells const& rivers = level.rivers;
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        if (rivers.receiver[n] < 0) {
            continue;
        }
        auto const r = static_cast<std::size_t>(rivers.receiver[n]);
        float const below = level.z[rivers.cell[r]];
        float& z = level.z[rivers.cell[n]];
        if (rivers.level[n] != 0) {
            z = below;
        } else if (heights == RiverHeights::graded) {
            z = std::max(z, above(below));
        } else if (rivers.number[r] >= 0) { // what lies beyond the caller's grid shall not lift what is given
            z = std::max(z, std::nextafter(below, std::numeric_limits<float>::infinity()));
        }
    }
    auto const offsets = level.offsets();
    each_inner(level, [&](std::size_t i) {
        if (level.cover[i] == Cover::edge) {
            level.z[i] = std::max(level.z[i], above(highest_river(level, i, offsets)));
        }
    });
    for (std::size_t at = level.order.size(); at-- > 0;) {
        std::size_t const i = level.order[at];
        float least = above(level.z[moved(i, offsets[static_cast<std::size_t>(level.way[i])])]);
        if (is_bank(level.cover[i])) {
            least = std::max(least, above(highest_river(level, i, offsets)));
        }
        level.z[i] = std::max(level.z[i], least);
    }
}

} // namespace thalweg::surface
