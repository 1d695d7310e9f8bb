// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/flow/route.hpp>

// Idea: Each cell belongs to the first river cell that its water meets, and from there water keeps
// to the river. So areas never fall downstream, also where the DEM's steepest descent leaves the
// river for a bank. first_met follows each path until a cell that is known and writes the answer
// back along it: every cell is visited a fixed number of times. Without a DEM the nearest network
// cell takes the place of the flow path, by an exact distance transform with ties to the lower
// number.
// Source: ours: docs/decisions/0007-areas.md.
// Cost: O(n + cells of rivers), besides 4 to 8 bytes a cell. One thread.
// Not for: the DEM's own areas (FlowField::area_cells); catchments of points
// (given_directions.hpp). areas_nearest knows no divides: it halves the distance between rivers.
// Example:
//     Catchments const parts = catchments(reaches_of(network), flow_field);
//     std::int64_t const of_first_cells = parts.upstream[0];
//     ContributingAreas const areas = areas_d8(network, flow_field);
// More: docs/measures.md.

namespace thalweg::flow {

using ReachId = std::int64_t; ///< number of a reach; -1: none

/// A piece of river and the reach it flows into. Unlike an arc it may lie partly outside the DEM and need not meet
/// others.
struct Reach {
    std::vector<std::vector<Vec2>> lines; ///< [m] its parts inside the grid
    ReachId ds = -1;                      ///< number of the reach downstream; -1: none
    std::int64_t id = 0;                  ///< its name in messages
};

using Reaches = std::vector<Reach>;

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
/// \return ascending by cell, each once
/// \throws BadInput naming a reach with a line outside the grid; as steps_to_outlet
std::vector<RiverCell> river_cells(Reaches const& reaches, Grid const& grid, Run const& run = {});

/// Contributing areas [m2] of a network.
struct ContributingAreas {
    std::vector<double> us_area_m2; ///< by arc, at its upstream end
    std::vector<double> ds_area_m2; ///< by arc, at its downstream end (just above a confluence)
    std::vector<double> node_m2;    ///< by node
    std::string source = "nearest"; ///< method: "nearest" or "d8"
};

/// Estimates contributing areas without a DEM: each cell drains to the network cell nearest by city-block distance
/// (ties: lower index). A network cell (cells_along) shared by several arcs belongs to the arc with the fewest arcs to
/// the outlet (ties: lower number): a confluence's cell to the arc that leaves it, an outlet's to an arc that enters
/// it.
/// \param network a forest inside the grid
/// \param grid its cells are distributed
/// \return at an arc's upstream end: the areas of the arcs that enter its node, plus the node's cell if it owns it; at
/// its downstream end: that plus its further cells. A node has the area of the arc that leaves it, an outlet the sum of
/// those that enter. Law: areas do not decrease downstream; the outlets' areas sum to the grid. A source whose cell
/// belongs to another arc has 0.
/// \throws BadInput naming the arc or node that is outside the grid or breaks the forest
ContributingAreas areas_nearest(StreamNetwork const& network, Grid const& grid, Run const& run = {});

/// Computes contributing areas from a DEM: a cell drains to the first river cell on its D8 flow path, and from there
/// along the river, even where the DEM's steepest descent leaves it. Owners of shared cells are as in areas_nearest.
/// \param network a forest inside the grid
/// \param drainage flow field of the DEM
/// \return Law: areas do not decrease downstream. Cells whose flow path leaves the grid without meeting a river count
/// for no arc.
/// \throws BadInput as areas_nearest
ContributingAreas areas_d8(StreamNetwork const& network, FlowField const& drainage, Run const& run = {});

/// Finds the first river cell on the D8 flow path of every cell.
/// \param cells as river_cells returns them
/// \param drainage flow field of the DEM
/// \return by cell: position in `cells`; -1: the path meets no river, or no data
/// \throws BadInput for 2^31 river cells or more
Raster<std::int32_t> first_met(std::vector<RiverCell> const& cells, FlowField const& drainage, Run const& run = {});

/// Incremental catchments of reaches.
struct Catchments {
    Raster<std::int32_t> reach;         ///< by cell: number of the reach; -1: none
    std::vector<std::int64_t> cells;    ///< by reach: size of its own catchment; 0: others own its cells
    std::vector<std::int64_t> upstream; ///< by reach: size of its own and all upstream catchments
    std::int64_t without = 0;           ///< cells with data in no catchment
};

/// Delineates incremental catchments: a cell belongs to the reach that owns the first river cell on its D8 flow path.
/// \param reaches lines inside the grid
/// \param drainage flow field of the DEM
/// \return each cell with data is in one catchment, or in none if its path leaves the grid without meeting a river;
/// `upstream` equals areas_d8's ds_area in cells
/// \throws BadInput as river_cells, and for 2^31 reaches or more
Catchments catchments(Reaches const& reaches, FlowField const& drainage, Run const& run = {});

} // namespace thalweg::flow
