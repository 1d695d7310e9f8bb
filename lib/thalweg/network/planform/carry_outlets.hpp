// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// Options of carry_outlets().
struct CarryParams {
    bool join = true;           ///< rivers of other basins may be joined; else an outlet without a way out stays
    double join_cells = 20.0;   ///< [cells] >= 0, what joining costs
    double beside_cells = 60.0; ///< [cells] >= 0, what a cell two cells or less from a river costs besides: there water
                                ///< leaves for the other river
};

/// What carry_outlets() returns.
struct Carried {
    StreamNetwork network;
    std::vector<Finding> notes; ///< one an outlet that was carried, or that could not be
};

/// Carries every outlet that lies inside the grid to its border by the least-cost path of cells that meets no other
/// river, or into a vertex of a river of another basin where that costs less: the last arc is drawn on (a new arc, the
/// last by number, where several end in the outlet), and the river that is joined becomes two arcs.
/// \pre a network inside the grid. Entering a cell costs the step's length times 1 + 10 / (d + 1/2)^2, d: city-block
/// distance to the rivers [cells], and what params say. Of equal ways the straighter.
/// \param network the network
/// \param grid the grid
/// \param params options, each with its default, unit and range
/// \return drawn vertices kept bit for bit; no crossing added, neither of lines nor of the cells they are drawn into.
/// notes: "carried_outlet" or "joined_outlet" (amount: metres), or "closed_basin", an outlet without a way out, left
/// where it is; feature: the line's id in its file, or the number of the arc, from 1.
/// \throws BadInput for a vertex outside the grid or a network that is not a forest
Carried carry_outlets(StreamNetwork const& network, Grid const& grid, CarryParams const& params = {});

/// \pre land, 0 for sea; every cell of a river is land.
/// \param network the network
/// \param land the cells of land; 0: sea
/// \param reach_cells outlets farther away from both, in steps of king's moves, are left where they are, without a note
/// \param params options, each with its default, unit and range
/// \return the same, to the border or a cell that touches the sea by a side or corner, whichever costs less, over land
/// alone.
Carried carry_outlets(StreamNetwork const& network, Mask const& land, std::int64_t reach_cells,
                      CarryParams const& params = {});

} // namespace thalweg::network
