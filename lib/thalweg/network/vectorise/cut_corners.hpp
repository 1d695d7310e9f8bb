// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// Cuts L-shaped corners of arcs that run from cell to cell, as pruning leaves them at former confluences: D8 flow
/// takes the diagonal.
/// \param network vertices at cell centres
/// \param cell_m [m] > 0, cell size
/// \param run progress, log, stop token and number of threads
/// \return without the vertices whose neighbours on the arc are one cell to the side and one above or below; of
/// successive corners every second is kept. Other vertices, nodes and arc numbers stay. Cutting again changes nothing.
/// \throws BadParameter when cell_m is outside its range
/// \throws Cancelled
///
/// Source: m-adjacency (specification 0.2) of the pruned network.
StreamNetwork cut_corners(StreamNetwork const& network, double cell_m, Run const& run = {});

} // namespace thalweg::network
