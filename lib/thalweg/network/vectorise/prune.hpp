// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/required.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// Options of prune().
struct PruneParams {
    Required<double> length_m; ///< [m] >= 0, L: no leaf arc shorter than this is left; 0 changes nothing but the
                               ///< thresholds
    Required<double> cell_m;   ///< [m] > 0, of the lattice on which the network was traced, or will be drawn
};

/// What prune() returns.
struct Pruned {
    StreamNetwork network; ///< every arc with its survival threshold
    std::int64_t arcs_before = 0;
};

/// Removes the shortest leaf arc, merges what it leaves at its confluence, and repeats until no leaf is shorter than L.
/// Of equal leaves the one with the northernmost source goes first, then the westernmost. A merged arc keeps the
/// feature and type of its longest piece; a basin whose every arc is too short vanishes.
/// \param network the network
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return no leaf arc shorter than L and no node of degree two but outlets; kept(L2) is a subset of kept(L1) for L1 <
/// L2; survives = the running maximum of the removed lengths [cells], so that an arc is kept exactly for L <= survives
/// * cell_m. Lengths are counted in whole 2^-24 cells a segment, L is rounded up to a whole number of them (but for
/// what a product of floats is too large by).
/// \throws BadParameter when L removes every arc; it names the longest that can be kept. BadInput for no arcs or no
/// forest
///
/// Source: \cite cao2009, equation 2, applied to leaves to a fixpoint (specification 0.2).
Pruned prune(StreamNetwork const& network, PruneParams const& params, Run const& run = {});

} // namespace thalweg::network
