// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/make/assess.hpp>
#include <thalweg/make/planform.hpp>
#include <thalweg/make/terrain.hpp>
#include <thalweg/recipe/plan.hpp>
#include <thalweg/recipe/recipe.hpp>

namespace thalweg::make {

/// A terrain with its plan and rivers.
struct Made {
    recipe::Plan plan;
    Planform planform; ///< without arcs where the plan has no [network]
    Terrain terrain;
    Assessment assessment;
    recipe::Recipe recipe; ///< recipe_of() these
};

/// Returns the fully resolved recipe; running it reproduces the terrain.
/// \param plan of the terrain
/// \param terrain made from the plan
/// \return with all defaults, the frame and the surface's choices
recipe::Recipe recipe_of(recipe::Plan const& plan, Terrain const& terrain);

/// Makes a terrain from a recipe: rivers first, then the terrain around them; or terrain from statistics and points
/// alone.
/// \return the same terrain for the same recipe, with any Run
Made make(recipe::Recipe const& recipe, Run const& run = {});

/// Collects the times of all stages.
/// \param made a terrain
/// \return [s] in order
Timings timings_of(Made const& made);

/// Collects all that was found: on the recipe and its files, the rivers, the terrain, and by the checks.
/// \param made a terrain
/// \return in this order
std::vector<Finding> findings_of(Made const& made);

} // namespace thalweg::make
