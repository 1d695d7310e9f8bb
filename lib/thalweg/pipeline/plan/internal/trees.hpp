// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/run/run.hpp>
#include <thalweg/network/growth/tokunaga/grow_tokunaga.hpp>
#include <thalweg/pipeline/plan/internal/plan.hpp>
#include <thalweg/pipeline/plan/plan.hpp>

/// Networks that branch by Tokunaga's law. Private to this module.
namespace thalweg::pipeline {

/// What helps where links find no room.
inline constexpr char const* more_room =
    "lower network.tokunaga.order or spacing, or take a larger grid (or smaller cells)";

/// The tree that a recipe grows by Tokunaga's law.
network::TokunagaParams tree_of(Recipe const& recipe);

/// Plans a tree that fills the grid or a region.
Plan plan_tree(Recipe recipe, Diary& diary, Run const& run);

/// Plans a tree along each stroke of a file.
Plan plan_strokes(Recipe recipe, Diary& diary, Run const& run);

} // namespace thalweg::pipeline
