// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <thalweg/geometry/natural_neighbours.hpp>
#include <thalweg/geometry/triangulate.hpp>
#include <thalweg/make/internal/between_rivers.hpp>
#include <thalweg/make/internal/numbers.hpp>
#include <thalweg/recipe/stages.hpp>
#include <thalweg/skeleton/draw_skeleton.hpp>
#include <thalweg/skeleton/regress.hpp>
#include <thalweg/surface/diffusion/diffusion.hpp>
#include <thalweg/surface/tin/rasterise_tin.hpp>

namespace thalweg::make {
namespace {

/// The default [surface] for points.
recipe::SurfaceRecipe surface_of_points() {
    recipe::SurfaceRecipe surface;
    surface.method = recipe::Method::tin;
    return surface;
}

/// The points of the terrain: from the file, or random with the extremes among them.
skeleton::ScatteredPoints points_of(recipe::Recipe const& recipe, Grid const& grid, FeaturePoints const& given,
                                    Run const& run) {
    if (!recipe.skeleton || recipe.skeleton->scatter == 0) {
        return {.points = given};
    }
    recipe::StatisticsRecipe const& s = asked(recipe);
    skeleton::ScatterParams params;
    params.seed = recipe.seed;
    params.count = recipe.skeleton->scatter;
    params.spacing_cells = recipe.skeleton->spacing_cells;
    params.law = recipe.skeleton->law;
    params.mean_m = mean_of(s);
    params.std_m = s.std.value_or(default_std_m);
    params.reach_cells = s.reach_cells;
    params.deviation = recipe.skeleton->deviation;
    params.falloff = recipe.skeleton->falloff;
    auto const place = [&](std::optional<std::array<double, 3>> const& e) -> std::optional<Vec3> {
        if (!e) {
            return std::nullopt;
        }
        Vec2 const at = grid.centre({static_cast<std::int64_t>((*e)[1]), static_cast<std::int64_t>((*e)[2])});
        return Vec3{at.x, at.y, (*e)[0]};
    };
    params.highest = place(s.max);
    params.lowest = place(s.min);
    return skeleton::scatter(grid, params, run);
}

/// grid: of the terrain, whose cells may be coarser than the recipe's, of cell_m.
Ground land_of_points(recipe::Recipe const& recipe, double cell_m, FeaturePoints const& points, Grid const& grid,
                      StageLog& stage_log, Run const& run) {
    recipe::SurfaceRecipe const wanted = recipe.surface.value_or(surface_of_points());
    recipe::StatisticsRecipe const& s = asked(recipe);
    if (wanted.method == recipe::Method::regress) {
        skeleton::RegressParams params = wanted.regress;
        double const step = grid.cell_m / cell_m;
        params.length_x = (s.length ? (*s.length)[0] : default_length_cells) / step;
        params.length_y = (s.length ? (*s.length)[1] : default_length_cells) / step;
        params.slope_rad = s.slope.value_or(0.0);
        skeleton::Regression regression = skeleton::regress(points, grid, params, run);
        if (regression.rank < regression.terms) {
            stage_log.find({.kind = "rank_deficient",
                            .amount = static_cast<double>(regression.terms - regression.rank),
                            .text = fmt::format("the points determine {} of {} terms of the regression",
                                                regression.rank, regression.terms),
                            .key = "surface.method"});
        }
        return {.dem = std::move(regression.surface), .how = ByRegression{}};
    }
    if (wanted.method == recipe::Method::diffuse) {
        Valley const no_rivers{Raster<float>(grid, std::numeric_limits<float>::quiet_NaN())};
        surface::DiffuseParams params = wanted.diffuse;
        params.seed = recipe.seed;
        params.tolerance = wanted.tolerance.value_or(params.tolerance);
        surface::DiffusedDem land =
            surface::diffuse(skeleton::draw_skeleton(no_rivers, {}, points, {}, run).skeleton, params, run);
        return {.dem = std::move(land.dem), .how = ByDiffusion{land.iterations, land.residual}};
    }
    Tin tin = geometry::triangulate(points.points, {}, run).tin;
    bool const natural = wanted.interpolation == recipe::Interpolation::natural;
    Raster<float> land = natural
                             ? geometry::natural_neighbours(points.points, grid,
                                                            {geometry::NaturalNeighboursParams::Outside::nearest}, run)
                             : surface::rasterise_tin(tin, grid, {surface::RasteriseTinParams::Outside::nearest}, run);
    return {.dem = std::move(land), .how = OverTriangles{}, .tin = std::move(tin)};
}

} // namespace

Surface points(GroundInput const& in, Run const& run) {
    StageLog stage_log(run);
    skeleton::ScatteredPoints const through = points_of(in.recipe, in.fine, in.points, run);
    Surface made;
    if (in.recipe.skeleton && in.recipe.skeleton->scatter > 0) {
        made.notes.checks.push_back(points_missing(through, *in.recipe.skeleton, stage_log));
    }
    made.ground = stage_log.stage(recipe::stage::land.name, [&] {
        return land_of_points(in.recipe, in.fine.cell_m, through.points, in.grid, stage_log, run);
    });
    stage_log.say(fmt::format("{} points", through.points.points.size()));
    made.notes.findings = stage_log.take_findings();
    made.notes.timings_s = stage_log.take();
    return made;
}

} // namespace thalweg::make
