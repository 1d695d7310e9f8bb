// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/make.hpp>

#include <thalweg/core/append.hpp>
#include <thalweg/make/internal/assess.hpp>
#include <thalweg/make/internal/ground.hpp>
#include <thalweg/make/internal/planform.hpp>
#include <thalweg/recipe/recipe_files.hpp>
#include <thalweg/recipe/stage_recipes.hpp>
#include <thalweg/recipe/stages.hpp>

namespace thalweg::make {

// Here, and nowhere below, a plan is taken apart: each step is given what it reads.

Planform make_planform(recipe::Plan const& plan, Run const& run) {
    if (!plan.recipe.network) {
        return {};
    }
    DrawnRivers rivers = draw_rivers({.recipe = recipe::recipe_for_planform(plan.recipe),
                                      .grid = plan.grid,
                                      .lines = plan.lines,
                                      .line_dem = plan.line_dem,
                                      .raster = plan.raster,
                                      .region = plan.region,
                                      .tree = plan.tree,
                                      .forest = plan.forest,
                                      .gaps = plan.land},
                                     run);
    Planform planform = std::move(rivers.planform);
    std::vector<Finding> const conversions = recipe::conversions(plan.recipe, planform.grid, run); // of all its files
    planform.findings.insert(planform.findings.begin() + static_cast<std::ptrdiff_t>(rivers.of_source),
                             conversions.begin(), conversions.end());
    run.report(planform.findings);
    return planform;
}

Terrain make_terrain(recipe::Plan const& plan, Planform const& planform, Run const& run) {
    return draw_terrain({.recipe = plan.recipe,
                         .grid = plan.grid,
                         .surface = {.recipe = recipe::recipe_for_surface(plan.recipe),
                                     .planform = planform,
                                     .points = plan.points,
                                     .ridges = plan.ridge_lines,
                                     .raster = plan.raster,
                                     .like = plan.like,
                                     .gaps = plan.land,
                                     .has_coastlines = recipe::stage::sea.runs(plan.recipe, plan.lines)}},
                        run);
}

Assessment assess(recipe::Plan const& plan, Planform const& planform, Terrain const& terrain, Run const& run) {
    return assess({.recipe = plan.recipe,
                   .planform = planform,
                   .terrain = terrain,
                   .lines = plan.lines,
                   .found_in_lines = plan.findings,
                   .points = plan.points,
                   .ridges = plan.ridge_lines,
                   .against = plan.against},
                  run);
}

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

MakeResult make(recipe::Recipe const& recipe, Run const& run) {
    MakeResult made;
    made.plan = recipe::resolve(recipe, run);
    made.planform = make_planform(made.plan, run);
    made.terrain = make_terrain(made.plan, made.planform, run);
    made.assessment = assess(made.plan, made.planform, made.terrain, run);
    made.recipe = recipe_of(made.plan, made.terrain);
    return made;
}

Timings timings_of(MakeResult const& made) {
    Timings all = made.plan.timings_s;
    append(all, made.planform.timings_s);
    append(all, made.terrain.notes.timings_s);
    append(all, made.assessment.timings_s);
    return all;
}

std::vector<Finding> findings_of(MakeResult const& made) {
    std::vector<Finding> all = made.plan.findings;
    append(all, made.planform.findings);
    append(all, made.terrain.notes.findings);
    append(all, made.assessment.findings);
    return all;
}

} // namespace thalweg::make
