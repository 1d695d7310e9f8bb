// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/flow_field.hpp>

namespace thalweg::flow {

/// Routes flow over any DEM by D8: steepest descent, through depressions and flats by priority-flood.
/// \param dem [m] by cell; NaN: no data; not changed
/// \param run progress, log, stop token and number of threads
/// \return each cell with data drains, without cycles, off the grid or into no data. A cell with a lower neighbour on
/// the filled DEM drains to the steepest (ties: lowest direction), any other towards the cell from which the flood
/// reached it; water leaves at cells on the border or beside no data that have no lower neighbour.
/// \throws BadInput when the DEM has no cells or an infinite height
/// \throws Cancelled
///
/// Source: \cite ocallaghan1984; \cite barnes2014; queue: radix heap of \cite ahuja1990.
FlowField route(Raster<float> const& dem, Run const& run = {});

/// Routes flow over a DEM with endorheic basins: water may also end in sinks, and what drains to them is not a
/// depression. \param dem [m] by cell; NaN: no data; not changed \param sinks indices of cells with data \param run
/// progress, log, stop token and number of threads \return as route without sinks \throws BadInput as route, and for a
/// sink off the grid or without data
FlowField route(Raster<float> const& dem, std::vector<std::int64_t> const& sinks, Run const& run = {});

} // namespace thalweg::flow
