// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

// Idea: A skeleton has burrs: short arcs without meaning. Cutting all arcs shorter than L would
// disconnect the network, because arcs beside the trunk are as short as burrs. So only leaves are
// cut, the shortest first, and where one confluence loses its second arc the other two become one,
// whose length is measured anew. An arc's persistence is the greatest length removed until it goes,
// itself included: arcs with persistence >= L are what pruning by L keeps. So networks for all L
// are nested, and one run serves a slider.
// Source: Cao, Long and Lü 2009, equation 2, which speaks of every arc; leaves to a fixpoint are
// ours: docs/decisions/0003-pruning.md.
// Cost: O(a log a) for a arcs (a heap of leaves), memory O(a). Lengths are integers, so that sums
// do not depend on order. One thread.
// Not for: thinning a network evenly (select arcs by order or area instead): interior arcs shorter
// than L stay. Rivers of a file: short tributaries are real there.
// Example:
//     Pruned const pruned = prune(network, {.length_m = 20.0 * grid.cell_m, .cell_m = grid.cell_m});
//     double const most_cells = pruned.network.arc(0).persistence; // largest L that keeps it

namespace thalweg::network {

/// Options of prune().
struct PruneParams {
    Required<double> length_m; ///< [m] >= 0, L: no shorter leaf arc remains; 0: only sets persistence
    Required<double> cell_m;   ///< [m] > 0, cell size of the lattice the network was traced on or will be drawn on
};

/// What prune() returns.
struct PrunedNetwork {
    StreamNetwork network; ///< every arc with its persistence
    std::int64_t arcs_before = 0;
};

/// Removes the shortest leaf arc, merges the two arcs left at its confluence, and repeats until no leaf is shorter than
/// L. Of equal leaves the one with the northernmost, then westernmost source goes first. A merged arc keeps the feature
/// and type of its longest piece; a basin whose arcs are all too short disappears.
/// \param network a forest
/// \return no leaf is shorter than L, only outlets have degree two; kept(L2) is a subset of kept(L1) for L1 < L2.
/// Persistence is the running maximum of removed lengths [cells]: an arc is kept exactly for L <= persistence * cell_m.
/// Lengths are whole multiples of 2^-24 cells per segment; L is rounded up to one.
/// \throws BadParameter when L removes every arc; names the largest L that does not
/// \throws BadInput for a network that has no arcs or is not a forest
///
/// Source: \cite cao2009, equation 2, applied to leaves to a fixpoint: docs/decisions/0003-pruning.md.
PrunedNetwork prune(StreamNetwork const& network, PruneParams const& params, Run const& run = {});

/// Cuts L-shaped corners of arcs that run from cell to cell, as pruning leaves them at former confluences: D8 flow
/// takes the diagonal.
/// \param network vertices at cell centres
/// \param cell_m [m] > 0, cell size
/// \return without the vertices whose neighbours on the arc are one cell to the side and one above or below; of
/// successive corners every second is kept. Other vertices, nodes and arc numbers stay. Cutting again changes nothing.
/// \throws BadParameter when cell_m is outside its range
///
/// Source: m-adjacency, which trace() requires of a skeleton.
StreamNetwork cut_corners(StreamNetwork const& network, double cell_m, Run const& run = {});

} // namespace thalweg::network
