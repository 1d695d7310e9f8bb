// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/forest/internal/grow_forest.hpp>

#include <algorithm>
#include <iterator>

namespace thalweg::network {

RegionWalk::RegionWalk(Mask const& region) : room_(room_in(region)), middle_{region.width() / 2, region.height() / 2} {
    trees_.reach(static_cast<std::int32_t>(std::max(region.width(), region.height()) / 2 + 1));
    law_.prepare(std::max<int>(std::ranges::max(room_.values()), 1));
}

bool RegionWalk::beside_a_tree(Cell c) const {
    return std::any_of(std::begin(neighbour_offsets), std::end(neighbour_offsets), [&](Site o) {
        return trees_.occupied({site(c).x + o.x, site(c).y + o.y});
    });
}

bool RegionWalk::approach(Cell& at, RandomStream& random) const {
    constexpr int most_jumps = 4096;
    for (int jumps = 0; jumps < most_jumps; ++jumps) {
        std::int32_t const free = trees_.free_half(site(at));
        if (free == 0 && beside_a_tree(at)) {
            return true;
        }
        std::int32_t const half = std::min<std::int32_t>(free, room_[framed(at)] - 1);
        if (half < 1) {
            step(at, random);
            continue;
        }
        ExitLaw::Offset const jump = law_.leave(half, random);
        at = {at.col + jump.x, at.row + jump.y};
    }
    return false;
}

void RegionWalk::step(Cell& at, RandomStream& random) const {
    Site const offset = neighbour_offsets[random.word() >> 62];
    Cell const next{at.col + offset.x, at.row + offset.y};
    if (inside(next) && !occupied(next)) {
        at = next;
    }
}

} // namespace thalweg::network
