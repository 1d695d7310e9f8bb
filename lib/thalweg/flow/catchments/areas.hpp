// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/grid.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/flow/flow_field.hpp>

namespace thalweg::flow {

/// Contributing areas [m2] of a network's arcs and nodes.
struct ContributingAreas {
    std::vector<double> us_area_m2; ///< by arc, at its upstream end
    std::vector<double> ds_area_m2; ///< by arc, at its downstream end (just above a confluence)
    std::vector<double> node_m2;    ///< by node
    char const* source = "nearest"; ///< "nearest" or "d8", for the run table
};

/// Without a DEM: each cell belongs to the network cell nearest by city-block distance (ties: lower index). A network
/// cell (cells_along) covered by several arcs belongs to the one with the fewest arcs to the outlet (ties: lower
/// number): the cell of a confluence to the arc that leaves it, the cell of an outlet to an arc that enters it.
/// \pre a network of trees inside the grid.
/// \param network the network
/// \param grid the grid
/// \param run progress, log, stop token and number of threads
/// \return us_area = what its node's arriving arcs bring, and the node's cell; ds_area = us_area and every further cell
/// of the arc; a node's area = us_area of the arc that leaves it, or the sum of what arrives at an outlet. So areas
/// never fall downstream, and the outlets' areas add up to the grid. A source whose cell belongs to another arc has 0.
/// \throws BadInput naming arc or node, otherwise
/// \throws Cancelled
ContributingAreas areas_nearest(StreamNetwork const& network, Grid const& grid, Run const& run = {});

/// With a DEM: a cell belongs to the first river cell its water meets by D8, and the water of a river stays in the
/// river. So areas never fall downstream, also where the steepest descent of the DEM would leave the river; cells whose
/// water leaves the grid before it meets a river belong to none. Owners of shared cells, areas at both ends and at
/// nodes, and what is thrown: as areas_nearest.
/// \param network the network
/// \param drainage the flow field of the DEM
/// \param run progress, log, stop token and number of threads
/// \return areas by arc and node, and the owner of each cell
ContributingAreas areas_d8(StreamNetwork const& network, FlowField const& drainage, Run const& run = {});

} // namespace thalweg::flow
