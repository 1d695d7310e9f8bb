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

/// \pre cells as river_cells gives them.
/// \param cells the cells
/// \param drainage the flow field of the DEM
/// \param run progress, log, stop token and number of threads
/// \return by cell, the place in cells of the river cell that its water meets first by D8; -1 where it leaves the grid
/// without meeting one, or without data.
/// \throws BadInput at 2^31 of them
/// \throws Cancelled
Raster<std::int32_t> first_met(std::vector<RiverCell> const& cells, FlowField const& drainage, Run const& run = {});

/// The area that each reach drains by itself.
struct Catchments {
    Raster<std::int32_t> reach;              ///< by cell: number of the reach; -1 for none
    Indexed<ReachId, std::int64_t> cells;    ///< of its own catchment; 0 where others own its cells
    Indexed<ReachId, std::int64_t> upstream; ///< cells of its catchment and of all those upstream
    std::int64_t without = 0;                ///< cells with data in no catchment
};

/// Incremental catchments of reaches: a cell belongs to the one that owns the first river cell its water meets by D8.
/// \param reaches the reaches
/// \param drainage the flow field of the DEM
/// \param run progress, log, stop token and number of threads
/// \return each cell with data in exactly one catchment, or in none when its water leaves the grid without meeting a
/// river; upstream as areas_d8 has ds_area, in cells.
/// \throws Error as river_cells
/// \throws BadInput at 2^31 reaches
/// \throws Cancelled
Catchments catchments(Reaches const& reaches, FlowField const& drainage, Run const& run = {});

} // namespace thalweg::flow
