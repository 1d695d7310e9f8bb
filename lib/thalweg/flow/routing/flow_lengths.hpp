// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/flow_field.hpp>

namespace thalweg::flow {

/// \param drainage the flow field of the DEM
/// \param run progress, log, stop token and number of threads
/// \return by cell: the longest way that water runs down to it by D8, from a divide [m]; 0 where none arrives or
/// without data.
/// \throws Cancelled
///
/// Source: the length of \cite hack1957 on a grid.
Raster<float> flow_lengths(FlowField const& drainage, Run const& run = {});

} // namespace thalweg::flow
