// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

// Idea: Some programs (TauDEM) allow two rivers at a confluence. Where more meet, one tributary
// after another is moved to a node of its own on the river: it leaves its line some metres before
// the confluence, runs beside the river and joins it a little farther down. Neighbours with the
// sharpest angle go first, for there a short link does it. Each try is tested exactly against all
// lines near by; while it would meet one, the distance is halved.
// Source: ours.
// Cost: linear in crowded confluences with few lines near them; the lines near are found by a
// segment tree, O(n log n) for n segments. One thread.
// Not for: networks that go to programs without this limit. Positions change by up to distance_m
// for each tributary that was moved.
// Example:
//     Split const split = split_confluences(elevated, {.max_upstream = 2});
//     std::size_t const added = split.pieces.size(); // arcs and nodes
// More: docs/interchange.md.

namespace thalweg::network {

/// Options of split_confluences().
struct SplitParams {
    int max_upstream = 2;    ///< [2, ...] arcs that may end at one node
    double distance_m = 0.0; ///< [m] >= 0, shift of a confluence; 0: the median segment length
};

/// An arc split off another at the new node of a moved tributary, with that node.
struct SplitPiece {
    std::size_t of = 0;    ///< number of the arc it was split off
    std::size_t moved = 0; ///< number of the arc that now ends at the new node
    bool upstream = false; ///< the new node lies upstream of the confluence, not downstream
};

/// What split_confluences() returns.
struct Split {
    ElevatedNetwork network;
    std::vector<SplitPiece> pieces; ///< in the order of splitting, as arcs and nodes are numbered
};

/// Splits confluences of too many arcs: one tributary after another is led beside the river to its own node a distance
/// downstream, or, at an outlet or without room, upstream.
/// \param network a forest; heights do not rise downstream
/// \return at most max_upstream arcs end at a node. Arcs and nodes keep their numbers; new ones follow, one of each per
/// piece, with the attributes of the arc they were split off. Lines change within distance_m times the number of moved
/// tributaries around a node; nothing new meets (exact), no arc has length 0, heights still do not rise. The distance
/// is shorter on short arcs.
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput naming the position, when the network is not a forest or lines leave no room
Split split_confluences(ElevatedNetwork const& network, SplitParams const& params = {}, Run const& run = {});

} // namespace thalweg::network
