// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/direction.hpp>

// Idea: Water runs by steepest descent, but DEMs have pits and flats. A priority flood enters from
// the border, lowest cell first, and raises each cell that it reaches to at least the level it came
// from: that is its spill level, found in one pass. Cells with a lower neighbour on the filled DEM
// drain to the steepest, others back along the way of the flood, so that no cycle can form; the DEM
// itself is not changed. If all cells fall, no flood is made. Areas are summed along flow paths,
// each cell after all its donors. route_dinf shares a cell's water between two neighbours, by the
// angle of the steepest of eight facets.
// Source: O'Callaghan and Mark 1984; Barnes et al. 2014; radix heap: Ahuja et al. 1990; order:
// Braun and Willett 2013; Tarboton 1997.
// Cost: O(n) but for the queue, whose entries move at most 32 times. docs/performance.md: 29 ns and
// 21 bytes a cell for a DEM of 2048 x 2048 that drains, 0.27 of the time of RichDEM. Directions run
// on all cores; flood and areas on one.
// Not for: changing a DEM (condition.hpp); the path of water in large flats, which follows the
// flood. Areas at cells whose catchment the edge cuts are too small (cut_by_edge in paths.hpp).
// Endorheic basins need `sinks`.
// Example:
//     FlowField const drainage = route(dem);
//     DinfFlow const shared = route_dinf(dem, drainage);
//     std::int64_t const area_cells = drainage.area_cells[Cell{40, 30}];
// More: docs/measures.md; docs/relief_measures.md, "Conventions beside other programs".

namespace thalweg::flow {

/// A depression: 8-connected cells below their spill level.
struct Depression {
    Cell lowest; ///< of several the first in row order
    std::int64_t cells = 0;
    double max_depth_m = 0.0;
    double volume_m3 = 0.0; ///< to its spill level
};

/// A number of cells, at most as many as a grid that is drained has: fewer than 2^32.
using CellCount = std::uint32_t;

/// D8 flow directions and contributing areas of a DEM. Law: directions stay on the grid, do not lead to cells without
/// data and form no cycle.
struct FlowField {
    Raster<Direction> direction;
    Raster<CellCount> area_cells;             ///< cells that drain through a cell, itself included; 0: no data
    std::int64_t pits = 0;                    ///< cells in depressions (below their spill level)
    double pit_volume_m3 = 0.0;               ///< of all depressions
    std::vector<Depression> depressions = {}; ///< in the order of their first cells

    Grid const& grid() const { return direction.grid(); }
    /// Finds the D8 receiver of a cell.
    /// \param cell index of the cell
    /// \return index of the neighbour; -1: none
    std::int64_t receiver(std::int64_t cell) const { return flow::receiver(direction, cell); }
};

/// Routes flow over any DEM by D8: steepest descent, through depressions and flats by priority-flood.
/// \param dem [m] by cell; NaN: no data; not changed
/// \return each cell with data drains, without cycles, off the grid or into no data. A cell with a lower neighbour on
/// the filled DEM drains to the steepest (ties: lowest direction), any other towards the cell from which the flood
/// reached it; water leaves at cells on the border or beside no data that have no lower neighbour.
/// \throws BadInput when the DEM has no cells, 2^32 cells or more, or an infinite height
///
/// Source: \cite ocallaghan1984; \cite barnes2014; queue: radix heap of \cite ahuja1990.
FlowField route(Raster<float> const& dem, Run const& run = {});

/// Routes flow over a DEM with endorheic basins: water may also end in sinks, and what drains to them is not a
/// depression.
/// \param dem [m] by cell; NaN: no data; not changed
/// \param sinks indices of cells with data
/// \return as route without sinks
/// \throws BadInput as route, and for a sink off the grid or without data
FlowField route(Raster<float> const& dem, std::vector<std::int64_t> const& sinks, Run const& run = {});

/// Computes the longest D8 flow path to every cell from a divide.
/// \param drainage flow field of the DEM
/// \return [m] by cell; 0: no inflow, or no data
///
/// Source: the length of \cite hack1957 on a grid.
Raster<float> flow_lengths(FlowField const& drainage, Run const& run = {});

/// \internal
/// The same lengths of a few cells, to the bit, without a raster of all.
/// \param cells of the grid, from each of which all cells above are visited
/// \return [m] by cell
std::vector<float> flow_lengths_to(std::vector<std::int64_t> const& cells, FlowField const& drainage,
                                   Run const& run = {});

inline constexpr float dinf_leaves = -1.0F; ///< water leaves the grid, or enters no data, here

/// D-infinity flow bearings and contributing areas of a DEM.
struct DinfFlow {
    /// [1/8 turn] in [0, 8), clockwise from the east, numbered as d8_steps: 2.25 sends a quarter of the water in
    /// direction 3 and the rest in direction 2. dinf_leaves, or NaN without data.
    Raster<float> bearing;
    Raster<double> area_cells; ///< cells that drain through a cell, itself included; 0: no data
};

/// Routes flow by D-infinity over a DEM with known D8 directions. A cell with a lower neighbour on the filled DEM
/// drains down the steepest of its eight triangular facets (ties: lowest bearing), divided by angle between the facet's
/// two neighbours; beside a cell without data, along the facet's other edge. Any other cell drains as by D8.
/// \param dem [m] by cell; NaN: no data
/// \param d8 as route returns it for this DEM; also gives the filled DEM
/// \return Law: the areas of cells where water leaves sum to the cells with data. There is no cycle: each step leads to
/// a lower filled level, or along D8 on the same level. Water leaves where it leaves by D8.
/// \throws BadInput when the directions belong to another grid or other cells, lead to no data or form a cycle
///
/// Source: \cite tarboton1997, eq. 1-6.
DinfFlow route_dinf(Raster<float> const& dem, FlowField const& d8, Run const& run = {});

} // namespace thalweg::flow
