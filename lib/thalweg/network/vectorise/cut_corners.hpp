// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// Cuts the L-shaped corners of arcs that run from cell to cell, which pruning leaves where a branch was: flow that
/// follows the steepest descent takes the diagonal.
/// \pre a network; cell_m > 0 [m].
/// \param network the network
/// \param cell_m [m] > 0, side of a cell
/// \param run progress, log, stop token and number of threads
/// \return the network without those vertices whose neighbours in the arc are one cell to the side and one above or
/// below; of corners in a row every second one is left. Other vertices, nodes and the numbers of arcs stay. Cutting
/// again changes nothing.
/// \throws BadParameter
/// \throws Cancelled
///
/// Source: m-adjacency (specification 0.2) of what is left after pruning.
StreamNetwork cut_corners(StreamNetwork const& network, double cell_m, Run const& run = {});

} // namespace thalweg::network
