// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// What lower_rises() returns.
struct Lowered {
    ElevatedNetwork network;
    std::vector<double> by_m; ///< [m] by arc number: how far its vertices were lowered at most, 0 for none
};

/// Lets every river fall: where one rises in the direction of flow, what lies downstream comes down to it.
/// \pre a network and the heights of its arcs' vertices; at a node they may differ.
/// \param network the network
/// \param arc_z [m] by arc, heights of its vertices
/// \return the highest heights that nowhere exceed those given and never rise downstream; those of arcs at a node
/// agree.
/// \throws BadInput when heights are not one a vertex, or a node has two arcs leaving it or a cycle is found
Lowered lower_rises(StreamNetwork const& network, std::vector<std::vector<double>> const& arc_z);

} // namespace thalweg::network
