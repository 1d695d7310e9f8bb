// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/grid.hpp>
#include <thalweg/core/indexed.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::flow {

using ReachId = std::int64_t; ///< number of a reach; -1 for none

/// A piece of river as water knows it: where it runs, and what it runs into. Those of anyone's file too, whose parts
/// may lie outside a DEM and need not meet.
struct Reach {
    std::vector<std::vector<Vec2>> lines; ///< [m] those parts of it that lie in the grid
    ReachId ds = -1;                      ///< number of the reach downstream, -1 for none
    std::int64_t id = 0;                  ///< by which messages name it
};

using Reaches = Indexed<ReachId, Reach>;

/// \param network the network
/// \return the arcs of a network, by number, with their arc_id.
/// \throws BadInput naming the node where a river parts
Reaches reaches_of(StreamNetwork const& network);

/// \param reaches the reaches
/// \return by reach: the reaches to the outlet, itself included: 1 for those that run into none.
/// \throws BadInput naming a reach when its ds is the number of none, or rivers run in a circle
std::vector<std::int64_t> steps_to_outlet(Reaches const& reaches);

/// A cell under rivers and the reach that owns it.
struct RiverCell {
    std::int64_t cell = 0;
    std::size_t reach = 0;
};

/// One under several belongs to the reach with the fewest steps to the outlet (ties: lower number): the cell of a
/// confluence to the reach that leaves it.
/// \param reaches the reaches
/// \param grid the grid
/// \param run progress, log, stop token and number of threads
/// \return the cells under reaches (cells_along), ascending, each once.
/// \throws BadInput naming a reach with a line outside the grid; as steps_to_outlet
/// \throws Cancelled
std::vector<RiverCell> river_cells(Reaches const& reaches, Grid const& grid, Run const& run = {});

} // namespace thalweg::flow
