// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/stream_network.hpp>

// Idea: A river that ends inside the grid leaves its water nowhere to go. Each such outlet is led
// on to the border, or the sea, by the cheapest way over the cells (A*). Entering a cell costs more
// the nearer rivers are, as if they repelled: a free way runs midway between others, and land
// beside it drains to one of them without doubt. A way never crosses a river or a diagonal step; it
// may end in a vertex of a river of another basin, at a fixed cost. Outlets nearest to an end go
// first, since their short ways leave most room.
// Source: A* of Hart, Nilsson and Raphael 1968; each step costs at least 1 and comes at most one
// cell nearer. Costs are ours.
// Cost: O(v log v) for the v cells that a search visits, outlet by outlet, besides some bytes a
// cell and the index of segments. One thread: a way avoids those before it.
// Not for: endorheic basins, which shall keep their outlet (leave it inside), nor gaps within a
// river (import_lines joins ends that nearly meet). A way knows no heights and may cross a real
// divide.
// Example:
//     CarriedNetwork const carried = carry_outlets(network, grid, {.join_cells = 40.0});
//     run.report(carried.notes); // carried_outlet, joined_outlet, closed_basin
//     StreamNetwork const& rivers = carried.network;

namespace thalweg::network {

/// Options of carry_outlets().
struct CarryParams {
    bool join = true;         ///< may join rivers of other basins; otherwise an outlet without a path stays
    double join_cells = 20.0; ///< [cells] >= 0, cost of joining
    /// [cells] >= 0, extra cost of a cell at most two cells from a river, where water might leave for that river
    double beside_cells = 60.0;
};

/// What carry_outlets() returns.
struct CarriedNetwork {
    StreamNetwork network;
    std::vector<Finding> notes; ///< one per outlet that was extended, or could not be
};

/// Extends every outlet inside the grid to the border, or into a vertex of a river of another basin if that costs less,
/// by the least-cost path that meets no other river. The last arc is extended (by a new one if several end in the
/// outlet), and a joined river is split. Entering a cell costs the step's length times 1 + 10 / (d + 1/2)^2, d:
/// city-block distance to rivers [cells], plus the costs in params (ties: the straighter path).
/// \param network a forest inside the grid
/// \param grid its border ends the paths
/// \return drawn vertices are kept bit for bit; no crossings are added, of lines or of their cells. notes:
/// "carried_outlet" or "joined_outlet" (amount: [m]), or "closed_basin": no path, left in place; feature: id of the
/// line in its file, or the arc's number from 1.
/// \throws BadInput for a vertex outside the grid or a network that is not a forest
CarriedNetwork carry_outlets(StreamNetwork const& network, Grid const& grid, CarryParams const& params = {});

/// Extends outlets over land to the border or to a cell that touches the sea by a side or corner, whichever costs less.
/// \param network a forest on land
/// \param land 0: sea
/// \param reach_cells [cells] chessboard distance; outlets farther from both are left in place without a note
/// \return as carry_outlets on a grid
CarriedNetwork carry_outlets(StreamNetwork const& network, Mask const& land, std::int64_t reach_cells,
                             CarryParams const& params = {});

} // namespace thalweg::network
