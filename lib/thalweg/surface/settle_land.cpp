// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/settle_land.hpp>

#include <thalweg/surface/small_step.hpp>

#include <algorithm>

namespace thalweg::surface {

void settle_land(LandLevel& level) {
    RiverCells const& rivers = level.rivers;
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        if (rivers.receiver[n] >= 0) {
            float& z = level.z[rivers.cell[n]];
            float const below = level.z[rivers.cell[static_cast<std::size_t>(rivers.receiver[n])]];
            z = rivers.level[n] != 0 ? below : std::max(z, just_above(below));
        }
    }
    auto const offsets = level.offsets();
    for (std::size_t at = level.order.size(); at-- > 0;) {
        std::size_t const i = level.order[at];
        float least = just_above(level.z[moved(i, offsets[static_cast<std::size_t>(level.way[i])])]);
        if (is_bank(level.cover[i])) {
            for (std::int64_t const offset : offsets) {
                if (std::size_t const n = moved(i, offset); level.cover[n] == Cover::river) {
                    least = std::max(least, just_above(level.z[n]));
                }
            }
        }
        level.z[i] = std::max(level.z[i], least);
    }
}

} // namespace thalweg::surface
