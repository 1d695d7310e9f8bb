// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/grid.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/flow/flow_field.hpp>

namespace thalweg::flow {

/// Contributing areas [m2] of a network.
struct ContributingAreas {
    std::vector<double> us_area_m2; ///< by arc, at its upstream end
    std::vector<double> ds_area_m2; ///< by arc, at its downstream end (just above a confluence)
    std::vector<double> node_m2;    ///< by node
    char const* source = "nearest"; ///< method: "nearest" or "d8"
};

/// Estimates contributing areas without a DEM: each cell drains to the network cell nearest by city-block distance
/// (ties: lower index). A network cell (cells_along) shared by several arcs belongs to the arc with the fewest arcs to
/// the outlet (ties: lower number): a confluence's cell to the arc that leaves it, an outlet's to an arc that enters
/// it.
/// \param network a forest inside the grid
/// \param grid its cells are distributed
/// \param run progress, log, stop token and number of threads
/// \return at an arc's upstream end: the areas of the arcs that enter its node, plus the node's cell if it owns it; at
/// its downstream end: that plus its further cells. A node has the area of the arc that leaves it, an outlet the sum of
/// those that enter. Law: areas do not decrease downstream; the outlets' areas sum to the grid. A source whose cell
/// belongs to another arc has 0.
/// \throws BadInput naming the arc or node that is outside the grid or breaks the forest
/// \throws Cancelled
ContributingAreas areas_nearest(StreamNetwork const& network, Grid const& grid, Run const& run = {});

/// Computes contributing areas from a DEM: a cell drains to the first river cell on its D8 flow path, and from there
/// along the river, even where the DEM's steepest descent leaves it. Owners of shared cells are as in areas_nearest.
/// \param network a forest inside the grid
/// \param drainage flow field of the DEM
/// \param run progress, log, stop token and number of threads
/// \return Law: areas do not decrease downstream. Cells whose flow path leaves the grid without meeting a river count
/// for no arc.
/// \throws BadInput as areas_nearest
ContributingAreas areas_d8(StreamNetwork const& network, FlowField const& drainage, Run const& run = {});

} // namespace thalweg::flow
