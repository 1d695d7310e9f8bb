// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/flow_field.hpp>

namespace thalweg::flow {

inline constexpr float dinf_leaves = -1.0F; ///< water leaves the grid, or enters no data, from this cell

/// Where the water of each cell goes when it may part between two neighbours (D-infinity).
struct DinfFlow {
    /// In eighths of a turn, [0, 8), clockwise from the east as d8_steps are numbered: 2.25 leads a quarter of the
    /// water in direction 3 and the rest in direction 2. dinf_leaves, or NaN without data.
    Raster<float> bearing;
    Raster<double> area_cells; ///< cells that drain through a cell, itself included; 0 without data
};

/// D-infinity bearings and contributing areas of a DEM of which D8 is known.
/// \pre the DEM and what route made of it.
/// \param dem [m] heights by cell; NaN: no data
/// \param d8 the D8 flow field of the DEM
/// \param run progress, log, stop token and number of threads
/// \return of a cell with a lower neighbour on the filled DEM, the steepest of the eight triangular facets around it
/// (ties: lowest bearing), its water shared between the facet's two neighbours by angle; a neighbour without data
/// leaves the other edge of its facet. Any other cell drains as by D8, and water leaves where it leaves by D8. No water
/// is lost: what leaves adds up to the cells with data. There is no cycle: each step leads to a lower level, or along
/// D8 on the same level. The filled DEM follows from D8: a cell stands at its own height or at the level of the cell it
/// drains to, whichever is higher.
/// \throws BadInput when the directions are of another grid or other cells, lead to no data or in a circle
/// \throws Cancelled
///
/// Source: \cite tarboton1997, eq. 1-6.
DinfFlow route_dinf(Raster<float> const& dem, FlowField const& d8, Run const& run = {});

} // namespace thalweg::flow
