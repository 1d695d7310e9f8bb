// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// Computes Strahler, Shreve, Hack and topological orders, basins and distances to the outlet. The main stem is the
/// longest flow path (ties: lower arc number).
/// \param network a forest
/// \return by arc and by node; 0: a node without arcs
/// \throws BadInput naming the position of a node that two arcs leave, or of a cycle
///
/// Source: \cite strahler1957; \cite shreve1966; \cite hack1957.
NetworkOrders order(StreamNetwork const& network);

} // namespace thalweg::network
