// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/order_cells.hpp>

namespace thalweg::surface {

void order_cells(LandLevel& level) {
    constexpr std::uint8_t done = 255;
    auto const offsets = level.offsets();
    Cells<std::uint8_t> awaited(level.way.size());
    for (std::size_t i = 0; i < awaited.size(); ++i) {
        if (level.way[i] >= 0) {
            ++awaited[moved(i, offsets[static_cast<std::size_t>(level.way[i])])];
        }
    }
    level.area.assign(level.way.size(), 1);
    for (Inflow const& in : level.inflow) {
        level.area[in.cell] += in.area;
    }
    level.order.resize(level.way.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i < awaited.size(); ++i) {
        for (std::size_t at = i; awaited[at] == 0;) {
            awaited[at] = done;
            if (level.way[at] < 0) {
                break;
            }
            if (is_land(level.cover[at])) {
                level.order[count++] = static_cast<std::uint32_t>(at);
            }
            std::size_t const next = moved(at, offsets[static_cast<std::size_t>(level.way[at])]);
            level.area[next] += level.area[at];
            --awaited[next];
            at = next;
        }
    }
    level.order.resize(count);
}

} // namespace thalweg::surface
