// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// What lower_rises() returns.
struct Lowered {
    ElevatedNetwork network;
    std::vector<double> by_m; ///< [m] by arc: the largest lowering of its vertices; 0: none
};

/// Removes rises downstream by lowering the vertices below.
/// \param network a forest
/// \param arc_z [m] by arc, by vertex; arcs may differ at a node
/// \return Law: the highest heights that nowhere exceed the input, do not rise downstream and agree at nodes
/// \throws BadInput when there is not one height per vertex, or the network is not a forest
Lowered lower_rises(StreamNetwork const& network, std::vector<std::vector<double>> const& arc_z);

} // namespace thalweg::network
