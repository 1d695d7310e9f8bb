// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/growth/dla/grow_dla.hpp>

// Idea: Diffusion-limited aggregation with walkers from everywhere. A walker starts at a uniform
// cell of the region and joins the first tree that it meets, if there is room. A branch therefore
// grows in proportion to the area that has no nearer branch, as a river fed by groundwater does,
// and trees from many outlets share the land among them: divides form where neither grows. A
// particle is s to s + 1 cells from its parent in any direction, and keeps 2 s from whatever it
// does not meet; these distances leave room for divides, hide the lattice and make crossings
// impossible, so that nothing is thinned, traced or checked afterwards. Cells that may still hold a
// particle are counted: when none is left, the region is full.
// Source: Witten and Sander 1981 for aggregation; Petroff et al. 2013 for growth in a Poisson
// field. Steps and distances are ours: docs/decisions/0014-forest.md.
// Cost: a full region holds about cells / (2 s^2) particles. Walkers jump over free squares as in
// dla/grow_dla.hpp and do not start in pockets where nothing can grow. docs/performance.md: 150 ns
// a cell on 40 x 40 cells, 12 bytes a cell, time as cells ^ 1.05. One thread: each walker depends
// on those before it.
// Not for: one large basin with a main valley (grow_dla, grow_tokunaga): trees of a forest compete,
// so a basin is as large as its neighbours allow. Land narrower than about s + 5 cells gets no
// river from plant_forest. A region has at most 2^20 cells a side, 4e9 in all.
// Example:
//     PlantedForest const grown = plant_forest(land, outlets, {.step_cells = 6, .visits = 2});
//     StreamNetwork const& rivers = grown.network;     // one tree an outlet
//     std::vector<Finding> const& notes = grown.notes; // outlets without room, dry land
// More: docs/rivers.md, "Forests: many basins".

namespace thalweg::growth {

/// Options of grow_forest().
struct ForestParams {
    std::int64_t step_cells = 5; ///< [1, 100] s: on the lattice a particle is s to s + 1 from its parent
    std::int64_t particles = 0;  ///< [0, ...] growth stops at this number, seeds included; 0: when the region is full
    double sticking = 1.0;       ///< (0, 1] probability that an arriving walker sticks; otherwise it walks on
    /// [1, 255] noise-reduction count: arrivals at a cell before a walker may stick; more make straighter rivers
    int visits = 1;
    std::uint64_t seed = 7;
};

enum class ForestStop : std::uint8_t { full, particles };

/// Trees in a region, one from each seed.
struct GrownForest {
    std::vector<Cell> cells;        ///< in order of arrival, the seeds first
    std::vector<ParticleId> parent; ///< by particle: its parent; -1: a seed
    std::vector<std::int64_t> tree; ///< by particle: number of its seed
    std::int64_t walkers = 0;       ///< number released
    ForestStop stop = ForestStop::full;
};

/// Grows trees from seeds into a region, all at once, until it is full. Walkers start uniformly in the region, stay
/// where a step would leave it, and end beside a tree (beside the cells nearer than s to a particle), where they stick
/// if the distances below allow it. So a branch grows in proportion to the area nearest to it (growth in a Poisson
/// field).
/// \param region 0: outside
/// \param seeds cells of the region, at least 2 s apart
/// \return a particle's parent is the nearest particle. It keeps 2 s from all others, s sqrt(3/2) from its siblings and
/// s sqrt(5/2) from its parent's parent: branches fork, but do not meet, in one tree or two, and without preferred
/// directions. Full: no cell that walkers can reach may hold a particle. Each walker has its own random stream (seed,
/// walker): the same bytes for any Run.
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput for no seed, a seed outside the region or two that are too close
///
/// Source: \cite witten1981, with walkers from everywhere; \cite petroff2013 (rivers in a Poisson field).
GrownForest grow_forest(Mask const& region, std::vector<Cell> const& seeds, ForestParams const& params = {},
                        Run const& run = {});

/// What plant_forest() returns.
struct PlantedForest {
    StreamNetwork network;
    std::vector<Finding> notes; ///< outlets left out or added, land without rivers
    std::int64_t outlets = 0;   ///< number with a tree
    std::int64_t particles = 0;
    std::int64_t walkers = 0;
    ForestStop stop = ForestStop::full;
};

/// Grows rivers from outlets on a coast until the land is full of them.
/// \param land 0: sea
/// \param outlets cells of the coast (coast_cells)
/// \param params as grow_forest; step_cells in [4, 100]
/// \return one tree per outlet, on land; vertices are cell centres; rivers of two trees leave two cells free between
/// them. notes: "crowded_outlet" (left out: too close to another river, or the land is too narrow), "added_outlet" (on
/// land from which no river reaches an outlet), "dry_land" (an island without room for a river; amount: [cells])
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput for no land, an outlet off the coast or no room for any river
PlantedForest plant_forest(Mask const& land, std::vector<Cell> const& outlets, ForestParams const& params = {},
                           Run const& run = {});

} // namespace thalweg::growth
