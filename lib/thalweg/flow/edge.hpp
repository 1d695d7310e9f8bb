// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/flow/route.hpp>

namespace thalweg::flow {

/// Finds the cells whose contributing area may reach beyond the data: water may enter cells on the border of the grid
/// or beside no data from outside, and runs on downstream of them.
/// \param drainage flow field of a DEM
/// \return by cell: 1 for those, 0 for others and for cells without data
///
/// Source: the edge contamination of TauDEM (Tarboton, AreaD8).
Mask cut_by_edge(FlowField const& drainage);

} // namespace thalweg::flow
