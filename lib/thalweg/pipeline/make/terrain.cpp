// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/terrain.hpp>

#include <thalweg/flow/catchments/areas.hpp>
#include <thalweg/flow/catchments/reaches.hpp>
#include <thalweg/flow/conditioning/condition.hpp>
#include <thalweg/flow/routing/route.hpp>
#include <thalweg/flow/routing/route_dinf.hpp>
#include <thalweg/io/gdal/access.hpp>
#include <thalweg/pipeline/make/internal/around_rivers.hpp>
#include <thalweg/pipeline/make/internal/land.hpp>
#include <thalweg/pipeline/make/internal/land_in_equilibrium.hpp>
#include <thalweg/pipeline/make/internal/paste_patches.hpp>
#include <thalweg/pipeline/make/internal/river_claims.hpp>
#include <thalweg/pipeline/plan/internal/append.hpp>
#include <thalweg/pipeline/plan/internal/diary.hpp>
#include <thalweg/pipeline/recipe/internal/conversions.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_asks.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_files.hpp>
#include <thalweg/pipeline/recipe/internal/unused_keys.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace thalweg::pipeline {

namespace {

/// The land with heights that drain, as the recipe wants it.
DrawnTerrain made_to_drain(DrawnTerrain drawn, Diary& diary, Run const& run) {
    if (!drawn.surface || !drawn.recipe.surface) {
        return drawn;
    }
    std::optional<flow::Conditioning>& method = drawn.recipe.surface->drain;
    method = method.value_or(drawn.recipe.network ? flow::Conditioning::carve : flow::Conditioning::none);
    if (*method == flow::Conditioning::none) {
        return drawn;
    }
    Valley const none{Raster<float>(drawn.grid, std::numeric_limits<float>::quiet_NaN())};
    flow::ConditionedDem land = diary.stage("carve", [&] {
        return flow::condition(std::move(drawn.surface->dem), drawn.recipe.network ? drawn.valley : none, {*method},
                               run);
    });
    drawn.surface->dem = std::move(land.dem);
    drawn.drained = {land.banks, land.depressions};
    diary.say(fmt::format("banks raised {:.0f} m3; depressions filled {:.0f} m3, cut {:.0f} m3", land.banks.raised_m3,
                          land.depressions.raised_m3, land.depressions.cut_m3));
    return drawn;
}

flow::FlowField drainage_of(DrawnTerrain const& drawn, Diary& diary, Run const& run) {
    Raster<float> const& dem = drawn.surface->dem;
    StreamNetwork const& plan = drawn.network.plan;
    bool const sinks = drawn.recipe.network && drawn.recipe.network->inland == InlandEnds::sink;
    run.at(0.0, fmt::format("drain {} cells", drawn.grid.cells()).c_str());
    return diary.stage("drain", [&] {
        return flow::route(
            dem, sinks ? cells_of(inland_ends(plan, dem), plan, drawn.grid) : std::vector<std::int64_t>{}, run);
    });
}

/// Land without rivers, on its grid, with a note on each conversion.
DrawnTerrain land_alone(Recipe const& wanted, Diary& diary, Run const& run) {
    FeaturePoints const points = given_points(wanted, run);
    Recipe recipe = wanted;
    recipe.grid.crs = points.crs;
    Grid const grid = frame_land(points, recipe.grid);
    recipe = framed(std::move(recipe), grid);
    if (recipe.skeleton) {
        require_on_grid(points, grid, recipe.skeleton->points);
    }
    std::vector<Finding> notes = report_conversions(recipe, grid, run);
    check_detail(recipe, grid.width, grid.height);
    DrawnTerrain drawn = make_land(recipe, grid, points, diary, run);
    drawn.notes = std::move(notes);
    return drawn;
}

DrawnTerrain land_with(Rivers const& rivers, Diary& diary, Run const& run) {
    refuse_unused_keys(rivers.recipe); // now that the rivers' heights are known
    FeaturePoints points;
    if (rivers.recipe.skeleton) {
        points = given_points(rivers.recipe, run);
        require_on_grid(points, rivers.grid, rivers.recipe.skeleton->points);
    }
    check_detail(rivers.recipe, rivers.grid.width, rivers.grid.height);
    return rivers.recipe.surface ? draw_around_rivers(rivers, points, diary, run) : without_land(rivers);
}

} // namespace

bool Terrain::passed() const {
    return std::all_of(checks.begin(), checks.end(), [](Check const& c) { return c.ok; });
}

Terrain together(Rivers rivers, DrawnTerrain drawn, Assessment found) {
    Terrain terrain;
    terrain.recipe = std::move(drawn.recipe);
    terrain.grid = drawn.grid;
    terrain.network = std::move(drawn.network);
    terrain.file = std::move(rivers.file);
    terrain.land = std::move(drawn.land);
    terrain.orders = std::move(drawn.orders);
    terrain.streams = std::move(drawn.streams);
    terrain.types = std::move(drawn.types);
    terrain.areas = std::move(found.areas);
    terrain.laws = std::move(found.laws);
    terrain.valley = std::move(drawn.valley);
    terrain.ridges = std::move(drawn.ridges);
    terrain.surface_ridges = std::move(found.surface_ridges);
    terrain.surface = std::move(drawn.surface);
    terrain.channels = std::move(drawn.channels);
    terrain.lakes = drawn.lakes;
    terrain.sinks = std::move(found.sinks);
    terrain.equilibrium = drawn.equilibrium;
    terrain.diffusion = drawn.diffusion;
    terrain.patches = std::move(drawn.patches);
    terrain.drained = drawn.drained;
    terrain.tin = std::move(drawn.tin);
    terrain.projection = std::move(drawn.projection);
    terrain.fine_forms_cells = drawn.fine_forms_cells;
    terrain.statistics = std::move(found.statistics);
    terrain.hypsometry = std::move(found.hypsometry);
    terrain.relief = std::move(found.relief);
    terrain.pits = found.pits;
    terrain.pit_volume_m3 = found.pit_volume_m3;
    terrain.certificate = std::move(found.certificate);
    terrain.catchments = std::move(found.catchments);
    terrain.water_areas = std::move(found.water_areas);
    terrain.story = std::move(rivers.story);
    append(terrain.story.repairs, std::move(drawn.notes));
    terrain.checks = std::move(found.checks);
    terrain.findings = std::move(found.findings);
    return terrain;
}

Terrain make_terrain(Recipe const& wanted, Run const& run, Keep const& keep) {
    check_recipe(wanted);
    io::RecipeFiles const confined;
    Diary diary(run);
    Rivers rivers = wanted.network ? make_rivers(wanted, run) : Rivers{};
    if (keep && wanted.network) {
        keep("valley", rivers.valley.z);
    }
    DrawnTerrain drawn = wanted.network ? land_with(rivers, diary, run) : land_alone(wanted, diary, run);
    drawn = made_to_drain(with_patches(std::move(drawn), diary, run), diary, run);
    if (keep && drawn.surface) {
        keep("surface", drawn.surface->dem);
    }
    std::optional<flow::FlowField> drainage;
    if (drawn.surface) {
        drainage = drainage_of(drawn, diary, run);
        drawn = with_side_valleys(std::move(drawn), *drainage, diary, run);
    }
    Assessment found = assess(drawn, drainage, run);
    drainage.reset();
    Timings timings_s = std::move(rivers.timings_s);
    append(timings_s, diary.take());
    append(timings_s, std::move(found.timings_s));
    Terrain terrain = together(std::move(rivers), std::move(drawn), std::move(found));
    terrain.timings_s = std::move(timings_s);
    return terrain;
}

} // namespace thalweg::pipeline
