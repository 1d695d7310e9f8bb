// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/terrain.hpp>

#include <utility>

#include <thalweg/core/run/kept.hpp>
#include <thalweg/core/run/stage_log.hpp>
#include <thalweg/make/internal/ground.hpp>
#include <thalweg/make/internal/raise_rivers.hpp>
#include <thalweg/make/internal/refine.hpp>
#include <thalweg/make/internal/water.hpp>
#include <thalweg/recipe/check_recipe.hpp>
#include <thalweg/recipe/made_from.hpp>
#include <thalweg/recipe/recipe_files.hpp>
#include <thalweg/recipe/stages.hpp>

namespace thalweg::make {
namespace {

/// A surface before patches and drainage.
Surface undrained(recipe::Plan const& plan, Planform const& planform, Run const& run) {
    recipe::Recipe const& recipe = plan.recipe;
    bool const has_rivers = recipe.network.has_value();
    Grid const& fine = has_rivers ? planform.grid : *plan.grid;
    StageLog stage_log(run);
    if (!has_rivers) {
        stage_log.find(recipe::conversions(recipe, fine));
        stage_log.find(require_targets(recipe, fine));
    } else if (!plan.grid) { // else it was checked before the rivers were grown
        recipe::check_detail(recipe, fine.width, fine.height);
        recipe::require_skeleton_on_grid(recipe, plan.points, plan.ridge_lines, fine);
    }
    RaisedRivers const raised = has_rivers && !heights_follow_terrain(recipe)
                                    ? raise_rivers(recipe, plan.raster, planform, stage_log, run)
                                    : RaisedRivers{};
    Grid const grid = has_rivers ? fine : recipe::coarse_grid(fine, recipe::levels_of(recipe));
    GroundInput const in{.recipe = recipe,
                         .grid = grid,
                         .fine = fine,
                         .planform = planform,
                         .rivers = raised,
                         .points = plan.points,
                         .ridges = plan.ridge_lines,
                         .raster = plan.raster,
                         .like = plan.like,
                         .gaps = plan.land,
                         .has_coastlines = has_rivers && has_coastlines(*recipe.network, plan.lines)};
    Surface surface = refined(ground_of(recipe)(in, run), in, run);
    stage_log.find(surface.notes.findings);
    stage_log.add(surface.notes.timings_s);
    surface.notes.findings = stage_log.take_findings();
    surface.notes.timings_s = stage_log.take();
    return surface;
}

/// The same, kept for the next terrain that is made from it.
Surface drawn(recipe::Plan const& plan, Planform const& planform, Run const& run) {
    return kept_or_made(
        run, "surface", [&] { return recipe::surface_made_from(plan.recipe, plan.heights_of_file); },
        [&] { return undrained(plan, planform, run); },
        [](Surface const& made) {
            constexpr std::int64_t of_cell = 16; // heights, valley, levels
            return of_cell * made.ground.dem.cells();
        });
}

void show(Raster<float> const& dem, bool is_finished, Run const& run) {
    if (run.preview) {
        run.preview(dem, is_finished);
    }
}

Terrain terrain_with_surface(recipe::Plan const& plan, Planform const& planform, Run const& run) {
    recipe::Recipe const& recipe = plan.recipe;
    bool const has_rivers = recipe.network.has_value();
    StageLog stage_log(run);
    Surface surface = drawn(plan, planform, run);
    stage_log.add(surface.notes.timings_s);
    stage_log.find(surface.notes.findings);
    if (surface.ground.equilibrium() == nullptr) { // in equilibrium it was seen, and drains as it is
        show(surface.ground.dem, false, run);
    }
    surface = with_patches(std::move(surface), recipe, stage_log, run);
    StreamNetwork const& network = surface.rivers.network.planform;
    Conditioned drained =
        conditioned(recipe, std::move(surface.ground.dem), surface.bed.valley, network, stage_log, run);
    show(drained.dem, true, run);
    flow::FlowField drainage = drainage_of(recipe, drained.dem, network, stage_log, run);
    RiversInBed made{std::move(surface.rivers), std::move(surface.bed)};
    if (adds_side_valleys(recipe)) {
        made = with_side_valleys(std::move(made), *recipe.network, drained.dem, drainage, stage_log, run);
    }
    flow::ContributingAreas areas =
        has_rivers ? flow::areas_d8(made.rivers.network.planform, drainage, run) : flow::ContributingAreas{};
    Ground ground = std::move(surface.ground);
    ground.dem = std::move(drained.dem);
    ground.land = recipe::on_raster(recipe) ? Mask{} : planform.land; // what has no data need not be sea
    return {
        .grid = has_rivers ? planform.grid : *plan.grid,
        .ground = std::move(ground),
        .rivers = std::move(made.rivers),
        .bed = std::move(made.bed),
        .water = {std::move(drainage), std::move(areas), drained.is_conditioned, drained.banks, drained.depressions},
        .notes = {std::move(surface.notes.checks), stage_log.take_findings(), stage_log.take()}};
}

/// Rivers that have heights of their own, where the recipe asks for no surface.
Terrain rivers_alone(recipe::Plan const& plan, Planform const& planform, Run const& run) {
    StageLog stage_log(run);
    RaisedRivers raised = raise_rivers(plan.recipe, plan.raster, planform, stage_log, run);
    Terrain terrain;
    terrain.grid = planform.grid;
    terrain.ground.land = planform.land;
    terrain.rivers = rivers_of(std::move(raised.network), planform.types, planform.file.clues);
    terrain.bed.valley = std::move(raised.valley);
    terrain.bed.heights = raised.statistics;
    terrain.water.areas =
        raised.areas ? std::move(*raised.areas) : flow::areas_nearest(planform.network, planform.grid, run);
    terrain.notes.findings = std::move(raised.findings);
    terrain.notes.timings_s = stage_log.take();
    return terrain;
}

} // namespace

Terrain make_terrain(recipe::Plan const& plan, Planform const& planform, Run const& run) {
    bool const rivers_only = plan.recipe.network && !plan.recipe.surface;
    Terrain terrain = rivers_only ? rivers_alone(plan, planform, run) : terrain_with_surface(plan, planform, run);
    run.report(terrain.notes.findings);
    return terrain;
}

} // namespace thalweg::make
