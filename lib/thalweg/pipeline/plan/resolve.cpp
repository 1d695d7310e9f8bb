// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/plan/plan.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/gdal/access.hpp>
#include <thalweg/network/import/clip_lines.hpp>
#include <thalweg/network/planform/rotate.hpp>
#include <thalweg/pipeline/plan/frame.hpp>
#include <thalweg/pipeline/plan/internal/forest_land.hpp>
#include <thalweg/pipeline/plan/internal/frame.hpp>
#include <thalweg/pipeline/plan/internal/plan.hpp>
#include <thalweg/pipeline/plan/internal/read_inputs.hpp>
#include <thalweg/pipeline/recipe/internal/check_recipe.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_files.hpp>

#include <fmt/format.h>

#include <filesystem>
#include <utility>

namespace thalweg::pipeline {

namespace {

void require_files(Recipe const& recipe) {
    for (NamedFile const& file : files_of(recipe)) {
        std::error_code ignored;
        if (!std::filesystem::exists(file_in(recipe, file.name), ignored)) {
            throw BadInput(fmt::format("pipeline.resolve: {} = \"{}\": there is no such file",
                                       file.key->place(file.item), file.name));
        }
    }
}

/// A cluster, whose grid is known only where it is asked for.
Plan plan_cluster(Recipe recipe) {
    NetworkRecipe& wanted = *recipe.network;
    recipe.grid.crs = io::projected_crs(recipe.grid.crs.empty() ? "EPSG:32631" : recipe.grid.crs);
    Plan plan;
    if (recipe.grid.width > 0) {
        plan.grid = frame_tree(1, recipe.grid);
    }
    check_memory_of_cluster(wanted.dla.particles);
    network::require_growth(wanted.dla);
    wanted.dla.seed = recipe.seed;
    wanted.rotate_deg = wanted.rotate_deg.value_or(in_equilibrium(recipe) ? network::random_turn(recipe.seed) : 0.0);
    plan.recipe = std::move(recipe);
    return plan;
}

Plan plan_forest(Recipe recipe, Diary& diary, Run const& run) {
    Plan plan;
    plan.recipe = on_crs_of_region(std::move(recipe));
    plan.forest = forest_land(plan.recipe, diary, run);
    plan.grid = plan.forest->land.grid();
    return plan;
}

/// Lines in their grid.
RiverLines clipped(RiverLines lines, Grid const& grid) {
    lines = network::clip_lines(lines, grid);
    if (lines.lines.empty()) {
        throw BadInput(fmt::format("grid: no river of {} runs inside the grid", lines.name));
    }
    return lines;
}

Plan plan_lines(Recipe recipe, Diary& diary, Run const& run) {
    RiverLines lines = diary.stage("read", [&] { return read_lines(recipe, run); });
    diary.say(fmt::format("{} lines from {}", lines.lines.size(), lines.name));
    OnLines settled = settle_on_lines(std::move(recipe), lines, run);
    Plan plan;
    plan.recipe = std::move(settled.recipe);
    Grid const grid = frame_lines(lines, plan.recipe.grid);
    run.tell("grid", fmt::format("{}x{} cells of {} m{}", grid.width, grid.height, grid.cell_m, settled.why));
    plan.grid = grid;
    plan.lines = plan.recipe.grid.clip ? clipped(std::move(lines), grid) : std::move(lines);
    LinesRecipe const& wanted = plan.recipe.network->lines;
    if (wanted.orientation == network::Orientation::automatic) {
        plan.line_dem = read_dem_in(file_in(plan.recipe, wanted.dem), grid.crs, "network.lines.dem", {}, run);
    }
    if (plan.recipe.network->heights == Heights::automatic && plan.lines.has_z) {
        plan.heights_of_file = true;
        plan.recipe.network->heights = Heights::file;
    }
    if (plan.recipe.network->heights == Heights::file && !plan.lines.has_z) {
        throw BadInput(fmt::format("network.heights = \"file\", but {} has lines without Z; choose other heights",
                                   plan.lines.name));
    }
    return plan;
}

/// Land without rivers.
Plan plan_points(Recipe recipe, Run const& run) {
    Plan plan;
    plan.points = given_points(recipe, run);
    recipe.grid.crs = plan.points.crs;
    plan.grid = frame_land(plan.points, recipe.grid);
    plan.recipe = std::move(recipe);
    return plan;
}

/// The plan by what rivers and land come from.
Plan by_source(Recipe const& recipe, Diary& diary, Run const& run) {
    if (!recipe.network) {
        return plan_points(recipe, run);
    }
    switch (recipe.network->source) {
    case Source::dla: return plan_cluster(recipe);
    case Source::forest: return plan_forest(recipe, diary, run);
    case Source::lines: return plan_lines(recipe, diary, run);
    case Source::tokunaga: break;
    }
    return recipe.network->tokunaga.strokes.empty() ? plan_tree(recipe, diary, run) : plan_strokes(recipe, diary, run);
}

/// How far rivers bend that a recipe says nothing of: on a coast short ones fall to the sea, which bend less.
double meander_of(Plan const& plan) {
    bool const has_sea = plan.forest && plan.forest->has_sea;
    return !grown_for_land(plan) ? 0.0 : has_sea ? 0.3 : 1.0;
}

/// With what a recipe leaves to the source of its rivers, and the points beside them.
Plan with_rivers_settled(Plan plan, Run const& run) {
    if (!plan.recipe.network) {
        return plan;
    }
    NetworkRecipe& rivers = *plan.recipe.network;
    if (rivers.heights == Heights::automatic) {
        rivers.heights = in_equilibrium(plan.recipe) ? Heights::graded : Heights::straight_repaired;
    }
    bool const all_over = rivers.source == Source::dla || rivers.source == Source::forest;
    rivers.prune_cells = rivers.prune_cells.value_or(all_over ? 20.0 : 0.0);
    rivers.meander = rivers.meander.value_or(meander_of(plan));
    refuse_unused_keys(plan.recipe); // now that the rivers' heights are known
    plan.points = plan.recipe.skeleton ? given_points(plan.recipe, run) : FeaturePoints{};
    return plan;
}

/// With what it leaves to the method of its surface.
Plan with_surface_settled(Plan plan) {
    if (!plan.recipe.surface) {
        return plan;
    }
    SurfaceRecipe& wanted = *plan.recipe.surface;
    EquilibriumRecipe& land = wanted.equilibrium;
    bool const has_rivers = plan.recipe.network.has_value();
    if (has_rivers && follows_land(plan.recipe) && !land.mean_slope_deg && !(wanted.dilate.relief_m > 0.0)) {
        land.mean_slope_deg = plan.recipe.network->source == Source::lines
                                  ? usual_slope_deg(plan.recipe.grid.cell_m)
                                  : surface::EquilibriumParams{}.mean_slope_deg;
    }
    wanted.drain = wanted.drain.value_or(has_rivers ? flow::Conditioning::carve : flow::Conditioning::none);
    return plan;
}

/// Throws where the grid, if it is known, cannot take what the plan puts on it.
void require_fit(Plan const& plan) {
    if (!plan.grid) {
        return;
    }
    check_memory(plan.grid->width, plan.grid->height);
    check_detail(plan.recipe, plan.grid->width, plan.grid->height);
    if (plan.recipe.skeleton) {
        require_on_grid(plan.points, *plan.grid, plan.recipe.skeleton->points);
    }
}

} // namespace

Plan resolve(Recipe const& recipe, Run const& run) {
    check_recipe(recipe);
    io::RecipeFiles const confined;
    Diary diary(run);
    Plan plan = by_source(recipe, diary, run);
    plan = with_rivers_settled(std::move(plan), run);
    plan = with_surface_settled(std::move(plan));
    require_files(plan.recipe);
    require_fit(plan);
    plan.timings_s = diary.take();
    return plan;
}

} // namespace thalweg::pipeline
