// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/run/stage_log.hpp>
#include <thalweg/make/internal/ground.hpp>

namespace thalweg::make {

/// A surface with the recipe's patches, in their order; rivers keep their cells' heights unless a patch says otherwise.
Surface with_patches(Surface surface, recipe::Recipe const& recipe, StageLog& stage_log, Run const& run);

/// A surface after hydrological conditioning, where the recipe asks for it.
struct Conditioned {
    Raster<float> dem;
    bool is_conditioned = false;
    flow::DemChange banks = {};
    flow::DemChange depressions = {};
};

/// Conditions a surface. Water leaves the land in sinks: meanwhile they are holes in it.
Conditioned conditioned(recipe::Recipe const& recipe, Raster<float> dem, Valley valley, StreamNetwork const& network,
                        StageLog& stage_log, Run const& run);

/// The flow field of a surface.
flow::FlowField drainage_of(recipe::Recipe const& recipe, Raster<float> const& dem, StreamNetwork const& network,
                            StageLog& stage_log, Run const& run);

/// Rivers in their cells.
struct RiversInBed {
    Rivers rivers;
    RiverBed bed;
};

/// Rivers with the side valleys of a surface in equilibrium as arcs.
/// dem, drainage: the surface as it drains
RiversInBed with_side_valleys(RiversInBed made, recipe::NetworkRecipe const& wanted, Raster<float> const& dem,
                              flow::FlowField const& drainage, StageLog& stage_log, Run const& run);

} // namespace thalweg::make
