// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/walk.hpp>

#include <algorithm>
#include <cmath>

#include <thalweg/core/error.hpp>

namespace thalweg::network {

namespace {

constexpr std::uint64_t growth_stage = 1;

/// Half side of a square around a site that lies within the far circle; 0 next to the circle.
std::int32_t within(BirthCircle const& circle, Site site) {
    constexpr double inverse_sqrt2 = 0x1.6a09e667f3bccp-1;
    return static_cast<std::int32_t>((circle.far - std::sqrt(static_cast<double>(squared(site)))) * inverse_sqrt2);
}

} // namespace

Walker walker(std::uint64_t seed, std::int64_t number) {
    return {{}, ChanceStream(seed, growth_stage, static_cast<std::uint64_t>(number))};
}

void Walk::occupy(Site site) {
    double const distance = std::sqrt(static_cast<double>(squared(site)));
    if (distance > radius_ || circle_.far2 == 0) {
        radius_ = distance;
        circle_ = birth_circle(distance);
        // A unit step may end one cell outside the far circle.
        squares_.reach(static_cast<std::int32_t>(circle_.far) + 2);
        law_.prepare(squares_.half());
    }
    squares_.occupy(site);
}

unsigned Walk::occupied_neighbours(Site site) const {
    unsigned mask = 0;
    for (unsigned d = 0; d < 4; ++d) {
        mask |= static_cast<unsigned>(occupied(neighbour(site, d))) << d;
    }
    return mask;
}

unsigned Walk::approach(Walker& walker) const {
    for (;;) {
        std::int64_t const distance2 = squared(walker.at);
        if (distance2 > circle_.far2) {
            walker.at = back_from_afar(circle_, walker.at, walker.chance);
            continue;
        }
        std::int32_t free = squares_.free_half(walker.at);
        if (free == 0) {
            unsigned const mask = occupied_neighbours(walker.at);
            if (mask != 0) {
                return mask;
            }
        }
        // A square that crosses the far circle would skip the walker's first site outside.
        Site const corner = {std::abs(walker.at.x) + free, std::abs(walker.at.y) + free};
        if (squared(corner) > circle_.far2) {
            free = within(circle_, walker.at);
        }
        ExitLaw::Offset const jump = law_.leave(std::max(free, 1), walker.chance);
        walker.at = {walker.at.x + jump.x, walker.at.y + jump.y};
    }
}

void Walk::step(Walker& walker) const {
    for (;;) {
        Site const next = neighbour(walker.at, static_cast<unsigned>(walker.chance.word() >> 62));
        if (!occupied(next)) {
            walker.at = next;
            return;
        }
    }
}

std::vector<Cell> first_arrivals(std::span<Cell const> cluster, std::int64_t walkers, std::uint64_t seed,
                                 Run const& run) {
    if (cluster.empty()) {
        throw BadInput("network.first_arrivals: the cluster has no cell, give at least one");
    }
    Walk walk;
    for (Cell const c : cluster) {
        walk.occupy({static_cast<std::int32_t>(c.col), static_cast<std::int32_t>(c.row)});
    }
    std::vector<Cell> hits;
    hits.reserve(static_cast<std::size_t>(walkers));
    for (std::int64_t i = 0; i < walkers; ++i) {
        if (i % 4096 == 0) {
            run.check();
        }
        Walker w = walker(seed, i);
        walk.release(w);
        walk.approach(w);
        hits.push_back({w.at.x, w.at.y});
    }
    return hits;
}

} // namespace thalweg::network
