// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/cells/d8.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::flow {

inline constexpr std::int8_t d8_leaves = -1;  ///< water leaves the grid, enters no data or ends in a sink, in this cell
inline constexpr std::int8_t d8_no_data = -2; ///< the cell has no height

/// Cells, side by side or by their corners, that lie below the level at which their water spills.
struct Depression {
    Cell lowest; ///< ties: the first in row order
    std::int64_t cells = 0;
    double max_depth_m = 0.0;
    double volume_m3 = 0.0; ///< of the water that would fill it
};

/// Where the water of each cell goes (D8).
struct FlowField {
    Raster<std::int8_t> direction;            ///< 0..7 as d8_steps, d8_leaves or d8_no_data
    Raster<std::int64_t> area_cells;          ///< cells that drain through a cell, itself included; 0 without data
    std::int64_t pits = 0;                    ///< cells in depressions (below the level at which they spill)
    double pit_volume_m3 = 0.0;               ///< of the water that would fill them
    std::vector<Depression> depressions = {}; ///< by their first cell
};

/// D8 directions and contributing areas of any DEM: steepest descent, through depressions and flats by priority-flood.
/// Gives: every cell with data drains, in at most as many steps as there are cells, off the grid or into no data. A
/// cell with a lower neighbour on the filled DEM goes to the one down the steepest slope (ties: lowest direction), any
/// other towards the cell from which the flood reached it; water leaves from cells at the border or beside no data that
/// have no lower neighbour. Filling is only a means: heights stay as they are. Throws: BadInput when the DEM has no
/// cells or an infinite height; Cancelled. Source: O'Callaghan and Mark 1984; Barnes, Lehman and Mulla 2014; queue:
/// radix heap of Ahuja, Mehlhorn, Orlin and Tarjan 1990.
FlowField route(Raster<float> const& dem, Run const& run = {});

/// The same of a DEM with closed basins: water also leaves from sinks, which are cells with data, and what drains to
/// them is no depression. Throws: BadInput for a sink off the grid or without data, too.
FlowField route(Raster<float> const& dem, std::vector<std::int64_t> const& sinks, Run const& run = {});

/// Contributing areas [m2] of a network's arcs and nodes.
struct ContributingAreas {
    std::vector<double> us_area_m2; ///< by arc, at its upstream end
    std::vector<double> ds_area_m2; ///< by arc, at its downstream end (just above a confluence)
    std::vector<double> node_m2;    ///< by node
    char const* source = "nearest"; ///< "nearest" or "d8", for the run table
};

/// Without a DEM: each cell belongs to the network cell nearest by city-block distance (ties: lower index).
/// A network cell (cells_along) covered by several arcs belongs to the one with the fewest arcs to the outlet (ties:
/// lower number): the cell of a confluence to the arc that leaves it, the cell of an outlet to an arc that enters it.
/// Gives: us_area = what its node's arriving arcs bring, and the node's cell; ds_area = us_area and every further cell
/// of the arc; a node's area = us_area of the arc that leaves it, or the sum of what arrives at an outlet. So areas
/// never fall downstream, and the outlets' areas add up to the grid. A source whose cell belongs to another arc has 0.
/// Takes: a network of trees inside the grid. Throws: BadInput, naming arc or node, otherwise; Cancelled.
ContributingAreas areas_nearest(StreamNetwork const& network, Grid const& grid, Run const& run = {});

/// With a DEM: a cell belongs to the first river cell its water meets by D8, and the water of a river stays in the
/// river. So areas never fall downstream, also where the steepest descent of the DEM would leave the river; cells whose
/// water leaves the grid before it meets a river belong to none. Owners of shared cells, areas at both ends and at
/// nodes, and what is thrown: as areas_nearest.
ContributingAreas areas_d8(StreamNetwork const& network, FlowField const& drainage, Run const& run = {});

} // namespace thalweg::flow
