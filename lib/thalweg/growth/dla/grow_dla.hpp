// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

// Idea: Diffusion-limited aggregation. Random walkers come from far away, one at a time, and stick
// where they touch the cluster. The probability that a walker arrives at a site solves Laplace's
// equation with 0 on the cluster: tips stand out and catch most walkers, bays are screened by them.
// So tips grow and split, and the cluster becomes a tree of arms with arms. With sticking S < 1
// walkers get deeper into the bays, and arms grow thicker; a site that must be visited M times
// first averages out chance, and arms grow straighter. Empty space costs little: a walker jumps to
// the boundary of the largest square that is known to be free, by the exact law with which the walk
// leaves it, and one that is far away returns to its launch circle by the exterior Poisson kernel.
// Source: Witten and Sander 1981; S and M as in Cao, Long and Lü 2009, equation 1 and section 2
// (Chiu, Lee and Tu 1992). The jumps are ours: docs/decisions/0005-growth.md; arms: 0006-arms.md.
// Cost: time grows as the number of particles ^ 1.09 (docs/performance.md: 1.3 us and 68 bytes a
// particle for 100 000); memory as the area of the cluster. S near 0 costs walkers:
// least_arrivals(). One thread, since each walker meets the cluster that those before it left.
// Not for: many basins or a region of given shape (forest/grow_forest.hpp); a bifurcation ratio
// that is known (tokunaga/grow_tokunaga.hpp). Arms follow the axes of the lattice, the more the
// larger M: turn the network afterwards (network/planform/rotate.hpp). A cluster is cells, not
// rivers: network/vectorise/ thins, traces and prunes it.
// Example:
//     Cluster const cluster = grow_dla({.particles = 30000, .visits = 3, .seed = 1});
//     Branch const arm = pick_branch(cluster, {.choice = BranchChoice::west});
//     Cell const first = arm.cells.front(); // relative to the seed, which is cell (0, 0)

namespace thalweg::growth {

enum class VisitRule : std::uint8_t {
    count_first,     ///< every arrival counts; walkers before the M-th are removed, later ones take the stick test
    stick_then_count ///< only passed stick tests count; walkers before the M-th are removed
};

/// Options of grow_dla().
struct DlaParams {
    std::int64_t particles = 26000; ///< [1, ...] size of the cluster, its seed included
    double sticking = 0.85;         ///< (0, 1] S: a walker with n occupied 4-neighbours sticks with probability S^(3-n)
    int visits = 3;                 ///< [1, 255] M, noise-reduction count: arrivals at a site before a walker may stick
    std::int64_t max_radius = 0;    ///< [cells] growth stops at this radius; 0: no limit
    VisitRule rule = VisitRule::count_first; ///< order of counting and stick test
    std::uint64_t seed = 7;
};

enum class GrowthStop : std::uint8_t { particles, radius };

using ParticleId = std::int64_t; ///< number of a particle in order of arrival; -1: none

/// A cluster on the lattice: the seed is cell (0, 0), columns count eastwards, rows southwards.
struct Cluster {
    std::vector<Cell> cells; ///< in order of arrival, the seed first
    std::vector<ParticleId>
        parent;               ///< by particle: the occupied 4-neighbour it sticks to (uniform choice); -1: the seed
    std::int64_t walkers = 0; ///< number released
    double radius = 0.0;      ///< [cells] largest distance from the seed
    GrowthStop stop = GrowthStop::particles;
};

/// Estimates the number of arrivals (walkers beside the cluster, one stick test each) that a cluster needs at least: a
/// compact one, whose rows each begin at a site with one neighbour, where a walker sticks with probability S^2.
/// \return [arrivals]
double least_arrivals(DlaParams const& params);

/// \internal
/// Checks options for grow_dla.
/// \throws BadParameter when a value is outside its range or growth needs more than 1e12 arrivals (about a day)
void require_growth(DlaParams const& params);

/// Grows a diffusion-limited aggregate from one seed: walkers from afar do the simple random walk of the lattice.
/// \return a 4-connected cluster. Each walker has its own random stream (seed, walker): the same cells for any number
/// of threads.
/// \throws BadParameter as require_growth
///
/// Source: \cite cao2009, equation 1 and section 2 (\cite chiu1992).
Cluster grow_dla(DlaParams const& params = {}, Run const& run = {});

enum class BranchChoice : std::uint8_t { largest, north, east, south, west, all };

/// Options of pick_branch().
struct BranchParams {
    BranchChoice choice = BranchChoice::largest; ///< which branch of the cluster; all: the whole cluster with its seed
    std::int64_t max_width = 0; ///< [cells] the branch ends at the first particle that makes its box wider; 0: no limit
    std::int64_t max_height = 0; ///< [cells] as max_width
    double turn_deg = 0.0;       ///< [-180, 180] the rotation that follows (rotate): the box is measured after it
};

/// What pick_branch() returns.
struct Branch {
    std::vector<Cell> cells; ///< lattice cells in order of arrival
    bool cut = false;        ///< a limit was reached before the last particle
};

/// Picks one branch of a cluster. `largest`: the descendants of that 4-neighbour of the seed with the most (ties: the
/// first to arrive), often nearly the whole cluster. A direction: the descendants of the particle with the most of them
/// in the quadrant around that direction, at least three in four of all its descendants (ties: the first to arrive).
/// \param cluster as grow_dla returns it
/// \return a 4-connected set of cells
/// \throws BadInput when the branch is empty
/// \throws BadParameter when a parameter is outside its range
///
/// Source: \cite cao2009, section 3.2, where the left arm is chosen by eye.
Branch pick_branch(Cluster const& cluster, BranchParams const& params = {});

} // namespace thalweg::growth
