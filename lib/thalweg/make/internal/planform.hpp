// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/make/planform.hpp>
#include <thalweg/network/elevation/river_types.hpp>
#include <thalweg/recipe/plan.hpp>
#include <thalweg/recipe/recipe.hpp>
#include <thalweg/recipe/stages.hpp>

namespace thalweg::make {

/// A network as its source gives it, before it is pruned, carried, bent and typed.
struct SourceRivers {
    StreamNetwork network;
    Grid grid;
    std::optional<ElevatedNetwork> file_heights = {}; ///< of the imported lines, where the recipe takes them
    Mask land = {};                                   ///< as Planform
    RiverFile file = {};
    NetworkStatistics statistics = {};
};

/// Grows or imports the rivers of a plan: one branch of a DLA cluster, networks by Tokunaga's law, a forest, or the
/// lines of a file.
SourceRivers rivers_of_source(recipe::Plan const& plan, StageLog& stage_log, Run const& run);

/// A network whose arcs name their types.
struct Typed {
    StreamNetwork network;
    network::RiverTypes types; ///< by arc; empty where the recipe asks for none
};

/// Assigns types where heights follow from them or the recipe asks for braided rivers. Arcs keep types that they have,
/// so that it may be repeated when arcs are added or removed.
Typed type_rivers(StreamNetwork network, recipe::NetworkRecipe const& wanted, Run const& run);

} // namespace thalweg::make
