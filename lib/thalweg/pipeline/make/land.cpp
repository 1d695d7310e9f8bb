// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/internal/terrain.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/pipeline/make/internal/land_parts.hpp>
#include <thalweg/pipeline/plan/internal/append.hpp>
#include <thalweg/pipeline/plan/internal/plan.hpp>
#include <thalweg/pipeline/plan/internal/read_inputs.hpp>
#include <thalweg/pipeline/recipe/internal/check_recipe.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_files.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace thalweg::pipeline {

namespace {

/// Cells that the mask of [surface] leaves out get no height.
Raster<float> left_out(Raster<float> land, Recipe const& recipe) {
    if (!recipe.surface || recipe.surface->mask.empty()) {
        return land;
    }
    Mask const inside = read_mask_of_land(file_in(recipe, recipe.surface->mask), land.grid());
    if (std::all_of(inside.values().begin(), inside.values().end(), [](std::uint8_t v) { return v == 0; })) {
        throw BadInput(fmt::format("surface.mask = \"{}\" leaves out every cell", recipe.surface->mask));
    }
    for (std::int64_t i = 0; i < land.cells(); ++i) {
        land[i] = inside[i] != 0 ? land[i] : std::numeric_limits<float>::quiet_NaN();
    }
    return land;
}

/// The coarse land that detail starts from, through points or at random.
Terrain begun(Plan const& plan, Terrain terrain, Diary& diary, Run const& run) {
    Recipe const& recipe = plan.recipe;
    int const levels = levels_of(recipe);
    Grid const coarse = coarse_grid(terrain.grid, levels);
    terrain.surface.emplace();
    if (recipe.statistics && recipe.statistics->skeleton != Prior::points) {
        terrain.surface->dem =
            diary.stage("land", [&] { return random_land(recipe, recipe.statistics->skeleton, coarse, levels, run); });
        diary.say(fmt::format("random, {}x{} cells of {} m", coarse.width, coarse.height, coarse.cell_m));
        return terrain;
    }
    skeleton::Scattered const points = points_of(recipe, terrain.grid, plan.points, run);
    if (scatters(recipe)) {
        terrain.checks.push_back(points_missing(points.missing, recipe.skeleton->scatter, run));
    }
    LandOfPoints made =
        diary.stage("land", [&] { return land_of_points(recipe, terrain.grid.cell_m, points.points, coarse, run); });
    diary.say(fmt::format("{} points", points.points.points.size()));
    terrain.surface->dem = std::move(made.land);
    terrain.tin = std::move(made.tin);
    terrain.diffusion = made.diffusion;
    return terrain;
}

/// The land with fractal detail, where the plan wants it.
Terrain detailed(Plan const& plan, Terrain terrain, Diary& diary, Run const& run) {
    int const levels = levels_of(plan.recipe);
    if (levels == 0) {
        return terrain;
    }
    Detailed made = diary.stage("detail", [&] { return with_detail(plan, terrain.surface->dem, terrain.grid, run); });
    terrain.detail = made.story;
    terrain.surface->dem = std::move(made.land);
    diary.say(fmt::format("midpoint displacement, {} levels", levels));
    return terrain;
}

/// The land with the statistics asked for.
Terrain projected(Plan const& plan, Terrain terrain, Diary& diary, Run const& run) {
    Brought brought = diary.stage("project", [&] {
        return brought_to_statistics(plan.recipe, std::move(terrain.surface->dem), plan.points, run);
    });
    diary.say(fmt::format("{} statistics within {:.2g} %, {} steps{}", brought.projection.residuals.size(),
                          100.0 * brought.projection.largest_error, brought.projection.iterations,
                          brought.fine_forms_cells > 0.0 ? ", fine forms of a Gaussian surface" : ""));
    append(terrain.checks, residual_checks(brought.projection));
    terrain.surface->dem = std::move(brought.projection.dem);
    brought.projection.dem = Raster<float>();
    terrain.projection = std::move(brought.projection);
    terrain.fine_forms_cells = brought.fine_forms_cells;
    return terrain;
}

} // namespace

Check points_missing(std::int64_t missing, std::int64_t wanted, Run const& run) {
    if (missing > 0) {
        run.say(fmt::format("warning: {} of {} points found no room; a smaller skeleton.spacing or skeleton.scatter "
                            "leaves them some",
                            missing, wanted));
    }
    return {"points_missing", static_cast<double>(missing), 0.0, missing == 0};
}

Terrain make_land(Plan const& plan, Diary& diary, Run const& run) {
    Terrain terrain;
    terrain.grid = *plan.grid;
    if (plan.recipe.statistics) { // before any work
        require_targets(*plan.recipe.statistics, terrain.grid, run);
    }
    terrain = begun(plan, std::move(terrain), diary, run);
    terrain = detailed(plan, std::move(terrain), diary, run);
    if (plan.recipe.statistics) {
        return projected(plan, std::move(terrain), diary, run);
    }
    terrain.surface->dem = left_out(std::move(terrain.surface->dem), plan.recipe);
    return terrain;
}

} // namespace thalweg::pipeline
