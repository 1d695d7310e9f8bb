// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/grid.hpp>
#include <thalweg/core/indexed.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/network/growth/dla/grow_dla.hpp>

namespace thalweg::network {

/// Options of grow_forest().
struct ForestParams {
    std::int64_t step_cells = 5; ///< [1, 100] s: on the lattice, a particle is s to s + 1 from the one it hangs on
    std::int64_t particles = 0;  ///< [0, ...] stop at so many, the seeds included; 0: when the region is full
    double sticking = 1.0;       ///< (0, 1] chance with which an arrival holds; else the walker walks on
    int visits = 1;              ///< [1, 255] arrivals a cell needs before it may hold: more make straighter rivers
    std::uint64_t seed = 7;
};

enum class ForestStop : std::uint8_t { full, particles };

/// Trees in a region, one a seed.
struct GrownForest {
    Indexed<ParticleId, Cell> cells;        ///< in order of arrival, the seeds first
    Indexed<ParticleId, ParticleId> parent; ///< by particle: the one it hangs on; -1 for a seed
    Indexed<ParticleId, std::int64_t> tree; ///< by particle: the number of its seed
    std::int64_t walkers = 0;               ///< released
    ForestStop stop = ForestStop::full;
};

/// Grows trees from the seeds into a region, all at once, until there is no cell left at which one could grow.
/// \pre a region (0 outside); seeds in it, at least 2 s apart. Walkers start uniformly in the region, walk its cells,
/// stay where a step would leave it, and end at the first cell beside a tree, that is beside the cells nearer than s to
/// a particle. There they become one, or nothing where none may be; so a branch grows with the land that has no nearer
/// one (growth in a Poisson field).
/// \param region 1 inside the region
/// \param seeds where trees begin
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return a particle hangs on the one nearest to it. It keeps 2 s from all others, but from the children of that one
/// only s sqrt(3/2), and from its parent s sqrt(5/2): branches fork, but neither meet nor touch, of one tree or of two,
/// and in all directions alike. Full: no cell that walkers from a seed could reach may hold a particle. Arrivals have
/// the law of unit steps, each walker has its own random stream (seed, walker): the same bytes for any Run.
/// \throws BadParameter
/// \throws BadInput for no seed, one outside the region or two that are too near
/// \throws Cancelled
///
/// Source: \cite witten1981, with walkers from everywhere; \cite petroff2013 (rivers in a Poisson field).
GrownForest grow_forest(Mask const& region, std::vector<Cell> const& seeds, ForestParams const& params = {},
                        Run const& run = {});

} // namespace thalweg::network
