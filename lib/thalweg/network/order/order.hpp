// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// Strahler, Shreve, Hack and topological orders, basins and distances to the outlet.
/// \param network a network whose components are trees
/// \return the orders by arc number and node; 0 for a node without arcs. Where several arcs end in an outlet, the one
/// on the longest path is the main stem.
/// \throws BadInput naming the place, when a node has two arcs leaving it or a cycle is found
///
/// Source: \cite strahler1957; \cite shreve1966; \cite hack1957 (main stem = longest flow path; ties: lower arc
/// number).
NetworkOrders order(StreamNetwork const& network);

} // namespace thalweg::network
