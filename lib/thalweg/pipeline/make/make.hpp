// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/pipeline/make/assess.hpp>
#include <thalweg/pipeline/make/planform.hpp>
#include <thalweg/pipeline/make/terrain.hpp>
#include <thalweg/pipeline/plan/plan.hpp>
#include <thalweg/pipeline/recipe/recipe.hpp>

namespace thalweg::pipeline {

/// A terrain with all that led to it.
struct Made {
    Plan plan;
    Planform planform; ///< without arcs where the plan has no [network]
    Terrain terrain;
    Assessment assessment;
    Recipe recipe; ///< recipe_of() these
};

/// \param terrain what came of it
/// \return the recipe with every default as it came out, also the frame and what the surface has decided: made again,
/// it gives the same terrain.
Recipe recipe_of(Plan const& plan, Terrain const& terrain);

/// From a recipe to a terrain: rivers first, then the land around them; or land from numbers and points alone.
/// \return the same terrain for the same recipe, whatever the Run.
Made make(Recipe const& recipe, Run const& run = {});

/// \param made a terrain
/// \return what all stages took [s], in their order.
Timings timings_of(Made const& made);

/// \param made a terrain
/// \return notes on what became of the rivers: adopted, carried, shortened.
std::vector<Finding> repairs_of(Made const& made);

} // namespace thalweg::pipeline
