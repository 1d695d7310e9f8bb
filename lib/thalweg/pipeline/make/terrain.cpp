// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/terrain.hpp>

#include <thalweg/flow/condition.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/io/gdal/access.hpp>
#include <thalweg/pipeline/make/internal/around_rivers.hpp>
#include <thalweg/pipeline/make/internal/paste_patches.hpp>
#include <thalweg/pipeline/make/internal/river_claims.hpp>
#include <thalweg/pipeline/make/internal/terrain.hpp>
#include <thalweg/pipeline/plan/internal/frame.hpp>
#include <thalweg/pipeline/plan/internal/plan.hpp>
#include <thalweg/pipeline/recipe/internal/check_recipe.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_files.hpp>

#include <fmt/format.h>

#include <limits>
#include <utility>

namespace thalweg::pipeline {

namespace {

/// Land without rivers, with a note on each conversion.
Terrain land_alone(Plan const& plan, Diary& diary, Run const& run) {
    std::vector<Finding> notes = report_conversions(plan.recipe, *plan.grid, run);
    Terrain terrain = make_land(plan, diary, run);
    terrain.notes = std::move(notes);
    return terrain;
}

/// Rivers without land, or with the land around them.
Terrain land_with(Plan const& plan, Rivers const& rivers, Diary& diary, Run const& run) {
    if (!plan.grid) { // else it was asked before the rivers were grown
        check_detail(plan.recipe, rivers.grid.width, rivers.grid.height);
        if (plan.recipe.skeleton) {
            require_on_grid(plan.points, rivers.grid, plan.recipe.skeleton->points);
        }
    }
    return plan.recipe.surface ? draw_around_rivers(plan, rivers, diary, run) : without_land(rivers);
}

/// The land with heights that drain, as the plan wants it.
Terrain made_to_drain(Plan const& plan, Terrain terrain, Diary& diary, Run const& run) {
    if (!conditions(plan.recipe)) {
        return terrain;
    }
    Valley const none{Raster<float>(terrain.grid, std::numeric_limits<float>::quiet_NaN())};
    flow::ConditionedDem land = diary.stage("carve", [&] {
        return flow::condition(std::move(terrain.surface->dem), plan.recipe.network ? terrain.valley : none,
                               {*plan.recipe.surface->drain}, run);
    });
    terrain.surface->dem = std::move(land.dem);
    terrain.drained = {land.banks, land.depressions};
    diary.say(fmt::format("banks raised {:.0f} m3; depressions filled {:.0f} m3, cut {:.0f} m3", land.banks.raised_m3,
                          land.depressions.raised_m3, land.depressions.cut_m3));
    return terrain;
}

/// The land with the ways of its water.
Terrain with_drainage(Plan const& plan, Terrain terrain, Diary& diary, Run const& run) {
    Raster<float> const& dem = terrain.surface->dem;
    StreamNetwork const& network = terrain.network.plan;
    bool const sinks = plan.recipe.network && plan.recipe.network->inland == InlandEnds::sink;
    run.at(0.0, fmt::format("drain {} cells", terrain.grid.cells()).c_str());
    terrain.drainage = diary.stage("drain", [&] {
        return flow::route(
            dem, sinks ? cells_of(inland_ends(network, dem), network, terrain.grid) : std::vector<std::int64_t>{}, run);
    });
    return terrain;
}

} // namespace

Terrain make_terrain(Plan const& plan, Rivers const& rivers, Run const& run) {
    io::RecipeFiles const confined;
    Diary diary(run);
    Terrain terrain = plan.recipe.network ? land_with(plan, rivers, diary, run) : land_alone(plan, diary, run);
    if (terrain.surface) {
        terrain = with_patches(plan, std::move(terrain), diary, run);
        terrain = made_to_drain(plan, std::move(terrain), diary, run);
        terrain = with_drainage(plan, std::move(terrain), diary, run);
        terrain = with_side_valleys(plan, std::move(terrain), diary, run);
    }
    terrain.timings_s = diary.take();
    return terrain;
}

} // namespace thalweg::pipeline
