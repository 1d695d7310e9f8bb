// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/valley.hpp>

namespace thalweg::flow {

/// Raises depressions to where they spill, and above that as little as lets water run.
/// Takes: a DEM whose river cells stand at the valley's heights (NaN where there is no river); rivers lead out of the
/// grid, down or level.
/// Gives: every cell with data has a strictly lower neighbour, is a river's, or lies at the grid's border or beside no
/// data. Only land is raised, none is lowered: each cell to the least height above both itself and the lowest way out,
/// by steps of one unit in the last place or 2^-16 m.
/// Throws: BadInput: another frame, no cells, an infinite height; Cancelled.
/// Source: Barnes, Lehman and Mulla 2014 (priority-flood with small steps).
Raster<float> fill(Raster<float> const& dem, Valley const& valley, Run const& run = {});

} // namespace thalweg::flow
