// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/stage_log.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/make/planform.hpp>
#include <thalweg/network/elevation/river_types.hpp>
#include <thalweg/recipe/plan.hpp>
#include <thalweg/recipe/recipe.hpp>

namespace thalweg::make {

/// What rivers are made from. It refers to values of a plan for the time of a call.
struct RiversInput {
    recipe::Recipe recipe; ///< with the keys that the stage reads: recipe_for_source() or recipe_for_planform()
    std::optional<Grid> const& grid;
    RiverLines const& lines; ///< this and what follows as Plan
    Raster<float> const& line_dem;
    Raster<float> const& raster;
    std::optional<Polygons> const& region;
    std::optional<growth::TokunagaTree> const& tree;
    std::optional<recipe::ForestLand> const& forest;
    Mask const& gaps; ///< Plan::land
};

/// Rivers, and how many of their findings are their source's.
struct DrawnRivers {
    Planform planform;
    std::size_t of_source = 0;
};

/// The rivers of a recipe that has any, kept for the next one that reads the same keys.
DrawnRivers draw_rivers(RiversInput const& in, Run const& run);

/// A network as its source gives it, before it is pruned, carried, bent and typed.
struct SourceRivers {
    StreamNetwork network;
    Grid grid;
    std::optional<ElevatedNetwork> file_heights = {}; ///< of the imported lines, where the recipe takes them
    Mask land = {};                                   ///< as Planform
    RiverFile file = {};
    NetworkStatistics statistics = {};
};

/// Grows or imports rivers: one branch of a DLA cluster, networks by Tokunaga's law, a forest, or the lines of a file.
SourceRivers rivers_of_source(RiversInput const& in, StageLog& stage_log, Run const& run);

/// A network whose arcs name their types.
struct TypedNetwork {
    StreamNetwork network;
    network::RiverTypes types; ///< by arc; empty where the recipe asks for none
};

/// Assigns types where heights follow from them or the recipe asks for braided rivers. Arcs keep types that they have,
/// so that it may be repeated when arcs are added or removed.
TypedNetwork type_rivers(StreamNetwork network, recipe::NetworkRecipe const& wanted, Run const& run);

} // namespace thalweg::make
