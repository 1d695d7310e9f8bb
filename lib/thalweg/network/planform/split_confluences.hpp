// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// Options of split_confluences().
struct SplitParams {
    int max_upstream = 2;    ///< [2, ...] arcs that may end in one node
    double distance_m = 0.0; ///< [m] >= 0: how far a confluence is moved; 0: the median length of the segments
};

/// An arc that was cut off another where a tributary was moved to, and the node between the two.
struct SplitPiece {
    std::size_t of = 0;    ///< number of the arc it was cut off
    std::size_t moved = 0; ///< number of the arc that now ends in the new node
    bool upstream = false; ///< the new node lies upstream of the confluence, not downstream
};

/// What split_confluences() returns.
struct Split {
    ElevatedNetwork network;
    std::vector<SplitPiece> pieces; ///< in the order in which they were cut, as arcs and nodes are numbered
};

/// Splits nodes in which more arcs end than may: one tributary after the other is led beside the river to a node of its
/// own, a distance downstream; at an outlet, or where there is no room downstream, upstream instead.
/// \param network a network whose components are trees and whose heights do not rise downstream
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return a network of the same laws with at most max_upstream arcs ending in a node. Arcs and nodes keep their
/// numbers; the new ones follow, one of each a piece, which has what the arc it was cut off has. Lines are redrawn
/// within a distance times the tributaries to be moved of the node; nothing meets that did not meet before (exact), no
/// arc is without length, and where heights did not rise they do not. Where an arc is short the distance is, too.
/// \throws BadParameter
/// \throws BadInput naming the place, when a component is not a tree or lines leave no room
/// \throws Cancelled
Split split_confluences(ElevatedNetwork const& network, SplitParams const& params = {}, Run const& run = {});

} // namespace thalweg::network
