// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/flow_field.hpp>

namespace thalweg::flow {

/// D8 directions and contributing areas of any DEM: steepest descent, through depressions and flats by priority-flood.
/// \param dem [m] heights by cell; NaN: no data
/// \param run progress, log, stop token and number of threads
/// \return every cell with data drains, in at most as many steps as there are cells, off the grid or into no data. A
/// cell with a lower neighbour on the filled DEM goes to the one down the steepest slope (ties: lowest direction), any
/// other towards the cell from which the flood reached it; water leaves from cells at the border or beside no data that
/// have no lower neighbour. Filling is only a means: heights stay as they are.
/// \throws BadInput when the DEM has no cells or an infinite height
/// \throws Cancelled
///
/// Source: \cite ocallaghan1984; \cite barnes2014; queue: radix heap of \cite ahuja1990.
FlowField route(Raster<float> const& dem, Run const& run = {});

/// \param dem [m] heights by cell; NaN: no data
/// \param sinks indices of the cells at which water ends
/// \param run progress, log, stop token and number of threads
/// \return the same of a DEM with closed basins: water also leaves from sinks, which are cells with data, and what
/// drains to them is not a depression.
/// \throws BadInput for a sink off the grid or without data, too
FlowField route(Raster<float> const& dem, std::vector<std::int64_t> const& sinks, Run const& run = {});

} // namespace thalweg::flow
