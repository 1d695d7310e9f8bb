// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/route.hpp>

// Idea: What can be said of a cell by following its water. Quantities that come from below (length
// to the outlet, height above the first river cell: HAND) are found by walking down until a known
// cell and filling in on the way back; those from above (orders, lengths) by visiting each cell
// after all its donors. cut_by_edge marks all that lies below a cell on the border, whose area may
// reach beyond the data.
// Source: Rennó et al. 2008 and Nobre et al. 2011 (HAND); Strahler 1957; Shreve 1966.
// Cost: O(n), each cell a fixed number of times. Orders in bands of rows on all cores, else one thread.
// Not for: lengths over hillslopes, where D8 paths zigzag between eight directions. HAND of a DEM
// with pits is below 0 there.
// Example:
//     std::vector<RiverCell> const rivers = cells_with_area(flow_field, 500);
//     Raster<float> const hand_m = heights_above_rivers(dem, rivers, flow_field);
// More: docs/measures.md.

namespace thalweg::flow {

/// Computes the length of the D8 flow path from each cell to where its water leaves.
/// \param drainage flow field of the DEM
/// \return [m] by cell; 0: water leaves here; NaN: no data
Raster<double> lengths_to_outlet(FlowField const& drainage, Run const& run = {});

/// Computes heights above the nearest drainage (HAND): above the first river cell on the D8 flow path.
/// \param dem [m] by cell; NaN: no data; not filled: cells in pits may lie below their river
/// \param rivers as river_cells or cells_with_area return them
/// \param drainage flow field of the DEM
/// \return [m] by cell; NaN: the path meets no river, or no data
/// \throws BadInput when DEM and flow field differ in grid; as first_met
///
/// Source: \cite renno2008; \cite nobre2011.
Raster<float> heights_above_rivers(Raster<float> const& dem, std::vector<RiverCell> const& rivers,
                                   FlowField const& drainage, Run const& run = {});

/// Lists the cells that at least so many cells drain through.
/// \param drainage flow field of the DEM
/// \param support_cells [1, ...]
/// \return ascending by cell, numbered as reaches 0, 1, ...
/// \throws BadParameter when support_cells is below 1
std::vector<RiverCell> cells_with_area(FlowField const& drainage, std::int64_t support_cells, Run const& run = {});

/// Stream orders by cell.
struct StreamOrders {
    Raster<std::uint8_t> strahler; ///< 0: no stream
    Raster<std::int64_t> shreve;   ///< number of sources upstream; 0: no stream
};

/// Computes stream orders of the cells that at least so many cells drain through.
/// \param drainage flow field of the DEM
/// \param support_cells [1, ...]
/// \return where streams of which several have the highest order meet, the order rises by one
/// \throws BadParameter when support_cells is below 1
///
/// Source: \cite strahler1957; \cite shreve1966.
StreamOrders stream_orders(FlowField const& drainage, std::int64_t support_cells, Run const& run = {});

/// Finds the cells whose contributing area may reach beyond the data: water may enter cells on the border of the grid
/// or beside no data from outside, and runs on downstream of them.
/// \param drainage flow field of a DEM
/// \return by cell: 1 for those, 0 for others and for cells without data
///
/// Source: the edge contamination of TauDEM (Tarboton, AreaD8).
Mask cut_by_edge(FlowField const& drainage);

} // namespace thalweg::flow
