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

/// A network in plan on its grid, with the file's heights where lines carry them.
struct RiversInPlan {
    StreamNetwork network;
    Grid grid;
    std::optional<ElevatedNetwork> file_heights = {};
    Mask land = {}; ///< 0: sea; without cells: all is land
    RiverFile file = {};
    NetworkStory story = {};
};

/// Grows or imports the rivers of a plan: one arm of a cluster, networks by Tokunaga's law, a forest or lines of a
/// file.
RiversInPlan rivers_in_plan(Plan const& plan, Diary& diary, Run const& run);

/// A network whose arcs say their types.
struct Typed {
    StreamNetwork plan;
    network::RiverTypes types; ///< by arc; empty where rivers have none
};

/// Gives the rivers types, written to the arcs, where heights follow from them or the recipe asks for braided ones.
/// To be repeated when arcs are added or removed: types that arcs have stay.
Typed type_rivers(StreamNetwork plan, NetworkRecipe const& wanted, Run const& run);

} // namespace thalweg::pipeline
