// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/flow_field.hpp>

namespace thalweg::flow {

/// Computes the longest D8 flow path to every cell from a divide.
/// \param drainage flow field of the DEM
/// \param run progress, log, stop token and number of threads
/// \return [m] by cell; 0: no inflow, or no data
/// \throws Cancelled
///
/// Source: the length of \cite hack1957 on a grid.
Raster<float> flow_lengths(FlowField const& drainage, Run const& run = {});

} // namespace thalweg::flow
