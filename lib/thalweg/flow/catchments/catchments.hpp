// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/catchments/reaches.hpp>
#include <thalweg/flow/flow_field.hpp>

namespace thalweg::flow {

/// Finds the first river cell on the D8 flow path of every cell.
/// \param cells as river_cells returns them
/// \param drainage flow field of the DEM
/// \param run progress, log, stop token and number of threads
/// \return by cell: position in `cells`; -1: the path meets no river, or no data
/// \throws BadInput for 2^31 river cells or more
/// \throws Cancelled
Raster<std::int32_t> first_met(std::vector<RiverCell> const& cells, FlowField const& drainage, Run const& run = {});

/// Incremental catchments of reaches.
struct Catchments {
    Raster<std::int32_t> reach;              ///< by cell: number of the reach; -1: none
    Indexed<ReachId, std::int64_t> cells;    ///< by reach: size of its own catchment; 0: others own its cells
    Indexed<ReachId, std::int64_t> upstream; ///< by reach: size of its own and all upstream catchments
    std::int64_t without = 0;                ///< cells with data in no catchment
};

/// Delineates incremental catchments: a cell belongs to the reach that owns the first river cell on its D8 flow path.
/// \param reaches lines inside the grid
/// \param drainage flow field of the DEM
/// \param run progress, log, stop token and number of threads
/// \return each cell with data is in one catchment, or in none if its path leaves the grid without meeting a river;
/// `upstream` equals areas_d8's ds_area in cells
/// \throws BadInput as river_cells, and for 2^31 reaches or more
/// \throws Cancelled
Catchments catchments(Reaches const& reaches, FlowField const& drainage, Run const& run = {});

} // namespace thalweg::flow
