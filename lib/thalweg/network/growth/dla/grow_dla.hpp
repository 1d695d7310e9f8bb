// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/grid.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::network {

enum class VisitRule : std::uint8_t {
    count_first,     ///< every arrival counts; below M the walker is removed, then the stick test
    stick_then_count ///< only passed stick tests count: below M the walker is removed, at the M-th it holds
};

/// Options of least_arrivals().
struct DlaParams {
    std::int64_t particles = 26000;          ///< [1, ...] size of the cluster, its seed included
    double sticking = 0.85;                  ///< (0, 1] S: a site with n occupied 4-neighbours holds with S^(3-n)
    int visits = 3;                          ///< [1, 255] M: arrivals a site needs before it may hold
    std::int64_t max_radius = 0;             ///< [cells] stop when the cluster reaches it; 0 for no limit
    VisitRule rule = VisitRule::count_first; ///< order of count and stick test
    std::uint64_t seed = 7;
};

enum class GrowthStop : std::uint8_t { particles, radius };

using ParticleId = std::int64_t; ///< number of a particle, in order of arrival; -1 for none

/// A cluster on the lattice; cell (0,0) is its seed, columns grow to the east, rows to the south.
struct Cluster {
    std::vector<Cell> cells; ///< in order of arrival, the seed first
    std::vector<ParticleId>
        parent;               ///< by particle: the occupied 4-neighbour it hangs on (uniform choice); -1 for the seed
    std::int64_t walkers = 0; ///< released
    double radius = 0.0;      ///< [cells] largest distance to the seed
    GrowthStop stop = GrowthStop::particles;
};

/// A compact cluster is least: each of its rows begins at a site with one neighbour, which holds with S².
/// \param params options, each with its default, unit and range
/// \return about the least number of arrivals (a walker beside the cluster, of which each takes a stick test) that a
/// cluster needs.
double least_arrivals(DlaParams const& params);

/// \param params options, each with its default, unit and range
/// \throws BadParameter where a value lies outside its range, or more than 1e12 arrivals are needed: about a day
void require_growth(DlaParams const& params);

/// Grows a diffusion-limited aggregate from one seed.
/// \param params sticking S and visit count M
/// \param run progress, log, stop token and number of threads
/// \return a 4-connected cluster; the walk is the simple random walk of the lattice released from afar, every walker
/// with its own random stream (seed, walker): the same cells for any number of threads.
/// \throws Error like require_growth
/// \throws Cancelled
///
/// Source: \cite cao2009, equation 1 and section 2 (\cite chiu1992).
Cluster grow_dla(DlaParams const& params = {}, Run const& run = {});

} // namespace thalweg::network
