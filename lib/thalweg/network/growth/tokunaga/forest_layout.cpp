// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/tokunaga/internal/forest_layout.hpp>

namespace thalweg::network {

ForestLayout::ForestLayout(Forest const& wanted)
    : forest(wanted), links(wanted.links.size()), at(links + wanted.shares.size()), up(at.size()),
      below(links, no_link), active(links, 0), spacing_m(links, 1.0) {
    for (std::size_t tree = 0; tree < wanted.shares.size(); ++tree) {
        at[links + tree] = wanted.shares[tree].mouth;
    }
    for (std::size_t link = 0; link < links; ++link) {
        if (wanted.links[link].pinned) {
            at[link] = *wanted.links[link].pinned;
        }
    }
}

std::size_t ForestLayout::node_below(std::size_t link) const {
    std::int64_t const down = forest.links[link].down;
    return down < 0 ? links + forest.links[link].tree : static_cast<std::size_t>(down);
}

std::size_t ForestLayout::lowest_link(std::size_t link) const {
    std::size_t lowest = link;
    while (node_below(lowest) != below[link]) {
        lowest = node_below(lowest);
    }
    return lowest;
}

std::size_t ForestLayout::main_above(std::size_t node) const {
    for (std::size_t const link : up[node]) {
        if (up[node].size() == 1 || forest.links[lowest_link(link)].turn == 0) {
            return link;
        }
    }
    return no_link;
}

void ForestLayout::place(std::size_t link, Vec2 to) {
    at[link] = to;
    placed->add(link, segment(link));
}

void ForestLayout::move(std::size_t link, Vec2 to) {
    placed->remove(link);
    for (std::size_t const above : up[link]) {
        placed->remove(above);
    }
    place(link, to);
    for (std::size_t const above : up[link]) {
        placed->add(above, segment(above));
    }
}

Vec2 direction_of(Vec2 a) {
    double const length = norm(a);
    return length > 0.0 ? Vec2{a.x / length, a.y / length} : Vec2{0.0, 1.0};
}

} // namespace thalweg::network
