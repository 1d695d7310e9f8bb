// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/dla/internal/walk.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>

namespace thalweg::network {

namespace {

constexpr std::uint64_t growth_stage = 1;

} // namespace

Walker walker(std::uint64_t seed, std::int64_t number) {
    return {{}, RandomStream(seed, growth_stage, static_cast<std::uint64_t>(number))};
}

void Walk::occupy(Site site) {
    double const distance = std::sqrt(static_cast<double>(squared(site)));
    if (distance > radius_ || circle_.far == 0) {
        radius_ = distance;
        circle_ = launch_circle(distance);
        squares_.reach(static_cast<std::int32_t>(distance) + 1);
        law_.prepare(circle_.far);
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
        std::int32_t const room = circle_.far - chebyshev(walker.at);
        if (room <= 0) {
            walker.at = back_from_afar(circle_, walker.at, walker.random);
            continue;
        }
        std::int32_t const free = squares_.free_half(walker.at);
        if (free == 0) {
            unsigned const mask = occupied_neighbours(walker.at);
            if (mask != 0) {
                return mask;
            }
        }
        // A wider square would jump over the walker's first site that is far.
        ExitLaw::Offset const jump = law_.leave(std::max(std::min(free, room), 1), walker.random);
        walker.at = {walker.at.x + jump.x, walker.at.y + jump.y};
    }
}

void Walk::step(Walker& walker) const {
    for (;;) {
        Site const next = neighbour(walker.at, static_cast<unsigned>(walker.random.word() >> 62));
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
    constexpr std::int64_t widest = 1 << 20;
    for (Cell const c : cluster) {
        if (std::abs(c.col) > widest || std::abs(c.row) > widest) {
            throw BadInput(fmt::format("network.first_arrivals: cell ({}, {}) lies more than {} cells from the centre",
                                       c.col, c.row, widest));
        }
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
