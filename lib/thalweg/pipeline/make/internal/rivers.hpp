// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/network/elevation/river_types.hpp>
#include <thalweg/pipeline/make/rivers.hpp>
#include <thalweg/pipeline/plan/internal/plan.hpp>
#include <thalweg/pipeline/plan/plan.hpp>
#include <thalweg/pipeline/recipe/recipe.hpp>

namespace thalweg::pipeline {

/// A network in plan on its grid, with the heights of its lines, if any.
struct RiversInPlan {
    StreamNetwork network;
    Grid grid;
    std::optional<ElevatedNetwork> file_heights = {};
    Mask land = {}; ///< 0: sea; without cells: all land
    RiverFile file = {};
    NetworkStory story = {};
};

/// Grows or imports the rivers of a plan: an arm of a cluster, networks by Tokunaga's law, a forest, or a file's lines.
RiversInPlan rivers_in_plan(Plan const& plan, Diary& diary, Run const& run);

/// A network whose arcs have types.
struct Typed {
    StreamNetwork plan;
    network::RiverTypes types; ///< by arc; empty: rivers have none
};

/// Assigns types to rivers and their arcs if heights depend on them or the recipe requests braided rivers. Repeat it
/// when arcs are added or removed: existing types stay.
Typed type_rivers(StreamNetwork plan, NetworkRecipe const& wanted, Run const& run);

} // namespace thalweg::pipeline
