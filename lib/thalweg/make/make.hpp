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
struct MakeResult {
    recipe::Plan plan;
    Planform planform; ///< without arcs where the plan has no [network]
    Terrain terrain;
    Assessment assessment;
    recipe::Recipe recipe; ///< recipe_of() these
};

/// Grows or imports the rivers of a plan: prunes short branches, carries outlets to where rivers may end, bends and
/// types the rivers.
/// \return the same rivers for the same plan, whatever the Run; none where the plan has no [network]
Planform make_planform(recipe::Plan const& plan, Run const& run = {});

/// Draws the terrain of a plan around its rivers; or from numbers and points alone where it has none.
/// \param planform the rivers of the plan; make_planform()
/// \return the same terrain for the same plan and rivers, whatever the Run.
Terrain make_terrain(recipe::Plan const& plan, Planform const& planform, Run const& run = {});

/// Measures and checks land and rivers.
/// \param planform rivers of the plan
/// \param terrain what came of them
/// \return measures and checks
Assessment assess(recipe::Plan const& plan, Planform const& planform, Terrain const& terrain, Run const& run = {});

/// Returns the fully resolved recipe; running it reproduces the terrain.
/// \param plan of the terrain
/// \param terrain made from the plan
/// \return with all defaults, the frame and the surface's choices
recipe::Recipe recipe_of(recipe::Plan const& plan, Terrain const& terrain);

/// Makes a terrain from a recipe: rivers first, then the terrain around them; or terrain from statistics and points
/// alone.
/// \return the same terrain for the same recipe, with any Run
MakeResult make(recipe::Recipe const& recipe, Run const& run = {});

/// Collects the times of all stages.
/// \param made a terrain
/// \return [s] in order
Timings timings_of(MakeResult const& made);

/// Collects all that was found: on the recipe and its files, the rivers, the terrain, and by the checks.
/// \param made a terrain
/// \return in this order
std::vector<Finding> findings_of(MakeResult const& made);

} // namespace thalweg::make
