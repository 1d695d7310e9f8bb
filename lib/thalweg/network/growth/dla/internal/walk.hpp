// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::network {

/// The four neighbours of a site: north, east, south, west.
inline constexpr Site neighbour_offsets[4] = {{0, -1}, {1, 0}, {0, 1}, {-1, 0}};

inline Site neighbour(Site s, unsigned direction) {
    return {s.x + neighbour_offsets[direction].x, s.y + neighbour_offsets[direction].y};
}

/// One random walker and its own chance.
struct Walker {
    Site at;
    RandomStream random;
};

/// The walker with this number, not yet born.
Walker walker(std::uint64_t seed, std::int64_t number);

/// The simple random walk of the lattice around a cluster, without its unit steps in empty space: a walker jumps to the
/// boundary of the largest square known to be free by that square's exit law. Law: the sites at which walkers arrive
/// next to the cluster have the distribution of the walk by unit steps between the same birth circles.
class Walk {
public:
    /// Occupies a site: the cluster grows by it.
    void occupy(Site site);

    double radius() const { return radius_; } ///< [cells] of the cluster
    bool occupied(Site site) const { return squares_.occupied(site); }
    std::int32_t half() const {
        return squares_.half();
    } ///< the cluster and its neighbours lie in -half <= x, y < half

    /// Puts a walker on the birth circle.
    void release(Walker& walker) const { walker.at = born(circle_, walker.random); }

    /// Walks until the walker stands on a free site with an occupied neighbour; there it may be already.
    /// Gives: the occupied neighbours, bit d for direction d.
    unsigned approach(Walker& walker) const;

    /// One step to a free neighbour, each as likely.
    void step(Walker& walker) const;

private:
    unsigned occupied_neighbours(Site site) const;

    FreeSquares squares_;
    ExitLaw law_;
    LaunchCircle circle_;
    double radius_ = 0.0;
};

/// Where walkers first arrive on a cluster that does not grow: the hit distribution, to be held against unit steps.
/// Takes: the occupied cells, (0,0) the centre of the birth circle.
/// Gives: one free cell with an occupied 4-neighbour for each of the walkers 0, 1, ... of this seed.
/// Throws: BadInput when no cell is occupied or one lies more than 2^20 cells from the centre; Cancelled.
std::vector<Cell> first_arrivals(std::span<Cell const> cluster, std::int64_t walkers, std::uint64_t seed,
                                 Run const& run = {});

} // namespace thalweg::network
