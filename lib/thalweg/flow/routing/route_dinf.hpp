// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/flow_field.hpp>

namespace thalweg::flow {

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
/// \param run progress, log, stop token and number of threads
/// \return Law: the areas of cells where water leaves sum to the cells with data. There is no cycle: each step leads to
/// a lower filled level, or along D8 on the same level. Water leaves where it leaves by D8.
/// \throws BadInput when the directions belong to another grid or other cells, lead to no data or form a cycle
/// \throws Cancelled
///
/// Source: \cite tarboton1997, eq. 1-6.
DinfFlow route_dinf(Raster<float> const& dem, FlowField const& d8, Run const& run = {});

} // namespace thalweg::flow
