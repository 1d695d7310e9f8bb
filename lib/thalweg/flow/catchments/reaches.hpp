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

using ReachId = std::int64_t; ///< number of a reach; -1: none

/// A piece of river and the reach it flows into. Unlike an arc it may lie partly outside the DEM and need not meet
/// others.
struct Reach {
    std::vector<std::vector<Vec2>> lines; ///< [m] its parts inside the grid
    ReachId ds = -1;                      ///< number of the reach downstream; -1: none
    std::int64_t id = 0;                  ///< its name in messages
};

using Reaches = Indexed<ReachId, Reach>;

/// Makes a reach of each arc.
/// \param network at most one arc leaves a node
/// \return by arc, with its arc_id
/// \throws BadInput naming the node at which a river bifurcates
Reaches reaches_of(StreamNetwork const& network);

/// Counts the reaches from each reach to its outlet.
/// \param reaches linked by `ds`
/// \return by reach, itself included: 1 at an outlet
/// \throws BadInput naming a reach whose ds does not exist, or that is part of a cycle
std::vector<std::int64_t> steps_to_outlet(Reaches const& reaches);

/// A cell under rivers and the reach that owns it.
struct RiverCell {
    std::int64_t cell = 0;
    std::size_t reach = 0;
};

/// Lists the cells of reaches (cells_along) and their owners. A shared cell belongs to the reach with the fewest steps
/// to the outlet (ties: lower number): a confluence's cell to the reach that leaves it.
/// \param reaches lines inside the grid
/// \param grid cells are numbered in it
/// \param run progress, log, stop token and number of threads
/// \return ascending by cell, each once
/// \throws BadInput naming a reach with a line outside the grid; as steps_to_outlet
/// \throws Cancelled
std::vector<RiverCell> river_cells(Reaches const& reaches, Grid const& grid, Run const& run = {});

} // namespace thalweg::flow
