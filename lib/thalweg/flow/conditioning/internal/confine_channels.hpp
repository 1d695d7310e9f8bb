// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/valley.hpp>

namespace thalweg::flow {

struct RaiseBanksParams {
    double margin_m = 0.002; ///< [m] >= 0: tools that count in millimetres (r.watershed) must see the bank
};

struct Banks {
    Raster<float> dem;
    Raster<float> least; ///< [m] what a cell beside a river must not be cut below, NaN for other cells
};

/// Raises the cells beside rivers as little as keeps each river's water in it.
/// Takes: a DEM whose river cells stand at the valley's heights.
/// Gives: of a river cell with a lower river cell beside it, the way down the steepest slope and the lowest neighbour
/// are river cells; a river cell without one (an outlet, a flat reach) has higher land around it. River cells and cells
/// without data stay as they are, and no cell is raised higher than this takes.
/// Throws: BadInput when the rasters have different frames; BadParameter.
Banks confine_channels(Raster<float> const& dem, Valley const& valley, RaiseBanksParams const& params = {},
                       Run const& run = {});

} // namespace thalweg::flow
