// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/valley.hpp>

/// Private to this module.
namespace thalweg::surface {

/// Share [0,1] of the cells of a DEM off the valley that have no lower 4-neighbour; 0 where there are none.
double flat_share(Valley const& valley, Raster<float> const& dem, Run const& run);

} // namespace thalweg::surface
