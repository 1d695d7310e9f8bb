// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/make.hpp>

#include <thalweg/recipe/stages.hpp>

namespace thalweg::make {

recipe::Recipe recipe_of(recipe::Plan const& plan, Terrain const& terrain) {
    recipe::Recipe recipe = plan.recipe;
    recipe.grid.width = terrain.grid.width;
    recipe.grid.height = terrain.grid.height;
    recipe.grid.origin = {terrain.grid.west, terrain.grid.north};
    if (terrain.ground.equilibrium()) {
        recipe.surface->equilibrium.edge = terrain.ground.equilibrium()->edge;
    }
    if (terrain.ground.detail.hurst > 0.0) {
        recipe.detail->midpoint.hurst = terrain.ground.detail.hurst;
        recipe.detail->midpoint.sigma = terrain.ground.detail.sigma;
    }
    return recipe;
}

Made make(recipe::Recipe const& recipe, Run const& run) {
    Made made;
    made.plan = recipe::resolve(recipe, run);
    made.planform = make_planform(made.plan, run);
    made.terrain = make_terrain(made.plan, made.planform, run);
    made.assessment = assess(made.plan, made.planform, made.terrain, run);
    made.recipe = recipe_of(made.plan, made.terrain);
    return made;
}

Timings timings_of(Made const& made) {
    Timings all = made.plan.timings_s;
    append(all, made.planform.timings_s);
    append(all, made.terrain.notes.timings_s);
    append(all, made.assessment.timings_s);
    return all;
}

std::vector<Finding> findings_of(Made const& made) {
    std::vector<Finding> all = made.plan.findings;
    append(all, made.planform.findings);
    append(all, made.terrain.notes.findings);
    append(all, made.assessment.findings);
    return all;
}

} // namespace thalweg::make
