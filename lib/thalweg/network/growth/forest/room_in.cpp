// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/forest/internal/grow_forest.hpp>

#include <algorithm>

#include <thalweg/core/cells.hpp>

namespace thalweg::network {

/// By two sweeps: exact, for all eight steps are as long.
Raster<std::uint8_t> room_in(Mask const& region) {
    Raster<std::uint8_t> room = framed<std::uint8_t>(region, 0);
    std::int64_t const width = room.width();
    for (std::uint8_t& r : room.values()) {
        r = r != 0 ? most_room : 0;
    }
    auto const lower = [&](std::int64_t i, std::int64_t sign) {
        for (std::int64_t const offset : {std::int64_t{1}, width - 1, width, width + 1}) {
            if (room[i] > 0) {
                room[i] = static_cast<std::uint8_t>(std::min<int>(room[i], room[i + sign * offset] + 1));
            }
        }
    };
    for (std::int64_t i = 0; i < room.cells(); ++i) {
        lower(i, -1);
    }
    for (std::int64_t i = room.cells() - 1; i >= 0; --i) {
        lower(i, 1);
    }
    return room;
}

} // namespace thalweg::network
