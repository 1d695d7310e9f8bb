// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/growth/dla/grow_dla.hpp>
#include <thalweg/growth/dla/internal/walk.hpp>

/// The oracle and yardstick of the growth: the same launch circle, return from afar and occupancy test, but every step
/// of a walker is a unit step.
namespace unit_step {

using thalweg::growth::Site;

/// Two bits a step: thirty-two steps a word.
class Steps {
public:
    explicit Steps(thalweg::RandomStream& random) : random_(random) {}

    unsigned next() {
        if (left_ == 0) {
            word_ = random_.word();
            left_ = 32;
        }
        --left_;
        auto const step = static_cast<unsigned>(word_ & 3);
        word_ >>= 2;
        return step;
    }

private:
    thalweg::RandomStream& random_;
    std::uint64_t word_ = 0;
    int left_ = 0;
};

class Lattice {
public:
    static constexpr std::uint8_t taken = 128;

    /// The state of a cell: `taken`, or the number of its occupied neighbours.
    std::uint8_t state(Site s) const { return cells_[index(s)]; }
    double radius() const { return radius_; }

    void occupy(Site site) {
        double const distance = std::sqrt(static_cast<double>(thalweg::growth::squared(site)));
        if (distance >= radius_) {
            radius_ = distance;
            circle_ = thalweg::growth::launch_circle(distance);
            widen(circle_.far + 2);
        }
        cells_[index(site)] |= taken;
        for (std::ptrdiff_t const step : {-width_, std::ptrdiff_t{1}, width_, std::ptrdiff_t{-1}}) {
            ++cells_[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(index(site)) + step)];
        }
        occupied_.push_back(site);
    }

    Site launch_site(thalweg::RandomStream& random) const { return thalweg::growth::launch_site(circle_, random); }

    /// Walks from a site that is not next to the cluster until it is.
    Site approach(Site site, Steps& steps, thalweg::RandomStream& random) const {
        while (state(site) == 0) {
            site = move(site, steps.next());
            if (circle_.lost(site)) {
                site = thalweg::growth::back_from_afar(circle_, site, random);
            }
        }
        return site;
    }

    /// One step to a free neighbour.
    Site step(Site site, Steps& steps) const {
        for (;;) {
            Site const next = move(site, steps.next());
            if (state(next) < taken) {
                return next;
            }
        }
    }

private:
    static Site move(Site s, unsigned step) {
        std::int32_t const way = (step & 1) != 0 ? 1 : -1;
        return (step & 2) != 0 ? Site{s.x + way, s.y} : Site{s.x, s.y + way};
    }
    std::size_t index(Site s) const { return static_cast<std::size_t>((s.y + half_) * width_ + s.x + half_); }

    void widen(std::int32_t half) {
        if (half <= half_) {
            return;
        }
        half_ = 2 * half;
        width_ = 2 * half_ + 1;
        cells_.assign(static_cast<std::size_t>(width_ * width_), 0);
        std::vector<Site> const before = std::move(occupied_);
        occupied_.clear();
        for (Site const s : before) {
            occupy(s);
        }
    }

    std::vector<Site> occupied_;
    std::vector<std::uint8_t> cells_;
    std::ptrdiff_t width_ = 0;
    std::int32_t half_ = 0;
    double radius_ = 0.0;
    thalweg::growth::LaunchCircle circle_;
};

/// The law of grow_dla word by word; parents are not recorded.
inline thalweg::growth::Cluster grow(thalweg::growth::DlaParams const& params) {
    thalweg::growth::Cluster cluster;
    Lattice lattice;
    std::vector<std::vector<int>> visits;
    auto const add = [&](Site s) {
        lattice.occupy(s);
        cluster.cells.push_back({s.x, s.y});
    };
    auto const count = [&](Site s) {
        auto const x = static_cast<std::size_t>(2 * std::abs(s.x) + (s.x < 0));
        auto const y = static_cast<std::size_t>(2 * std::abs(s.y) + (s.y < 0));
        visits.resize(std::max(visits.size(), y + 1));
        visits[y].resize(std::max(visits[y].size(), x + 1));
        return ++visits[y][x] >= params.visits;
    };
    add({0, 0});
    while (static_cast<std::int64_t>(cluster.cells.size()) < params.particles) {
        thalweg::RandomStream random(params.seed, 2, static_cast<std::uint64_t>(cluster.walkers++));
        Steps steps(random);
        for (Site s = lattice.approach(lattice.launch_site(random), steps, random);;) {
            double const hold = std::pow(params.sticking, 3 - lattice.state(s));
            bool removed = false;
            bool sticks = false;
            if (params.rule == thalweg::growth::VisitRule::count_first) {
                removed = !count(s);
                sticks = !removed && random.real() < hold;
            } else if (random.real() < hold) {
                sticks = count(s);
                removed = !sticks;
            }
            if (sticks) {
                add(s);
            }
            if (sticks || removed) {
                break;
            }
            s = lattice.approach(lattice.step(s, steps), steps, random);
        }
    }
    cluster.radius = lattice.radius();
    return cluster;
}

} // namespace unit_step
