// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/internal/land_parts.hpp>

#include <thalweg/geometry/natural_neighbours.hpp>
#include <thalweg/geometry/triangulate.hpp>
#include <thalweg/skeleton/draw_skeleton.hpp>
#include <thalweg/skeleton/regress.hpp>
#include <thalweg/surface/diffusion/diffusion.hpp>
#include <thalweg/surface/tin/rasterise_tin.hpp>

#include <fmt/format.h>

#include <limits>
#include <utility>

namespace thalweg::pipeline {

namespace {

/// What points without [surface] are drawn by.
SurfaceRecipe over_triangles() {
    SurfaceRecipe surface;
    surface.method = Method::tin;
    return surface;
}

} // namespace

skeleton::Scattered points_of(Recipe const& recipe, Grid const& grid, FeaturePoints const& given, Run const& run) {
    if (!recipe.skeleton || recipe.skeleton->scatter == 0) {
        return {.points = given};
    }
    StatisticsRecipe const& s = asked(recipe);
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

LandOfPoints land_of_points(Recipe const& recipe, double cell_m, FeaturePoints const& points, Grid const& grid,
                            Run const& run) {
    SurfaceRecipe const wanted = recipe.surface.value_or(over_triangles());
    StatisticsRecipe const& s = asked(recipe);
    if (wanted.method == Method::regress) {
        skeleton::RegressParams params = wanted.regress;
        double const step = grid.cell_m / cell_m;
        params.length_x = (s.length ? (*s.length)[0] : default_length_cells) / step;
        params.length_y = (s.length ? (*s.length)[1] : default_length_cells) / step;
        params.slope_rad = s.slope.value_or(0.0);
        skeleton::Regression regression = skeleton::regress(points, grid, params, run);
        if (regression.rank < regression.terms) {
            run.say(fmt::format("warning: the points determine {} of {} terms of the regression", regression.rank,
                                regression.terms));
        }
        return {std::move(regression.surface)};
    }
    if (wanted.method == Method::diffuse) {
        Valley const no_rivers{Raster<float>(grid, std::numeric_limits<float>::quiet_NaN())};
        surface::DiffuseParams params = wanted.diffuse;
        params.seed = recipe.seed;
        params.tolerance = wanted.tolerance.value_or(params.tolerance);
        surface::Diffused land =
            surface::diffuse(skeleton::draw_skeleton(no_rivers, {}, points, {}, run).skeleton, params, run);
        return {std::move(land.dem), {}, SolverStory{land.iterations, land.residual}};
    }
    Tin tin = geometry::triangulate(points.points, {}, run).tin;
    bool const natural = wanted.interpolation == Interpolation::natural;
    Raster<float> land = natural
                             ? geometry::natural_neighbours(points.points, grid,
                                                            {geometry::NaturalNeighboursParams::Outside::nearest}, run)
                             : surface::rasterise_tin(tin, grid, {surface::RasteriseTinParams::Outside::nearest}, run);
    return {std::move(land), std::move(tin)};
}

} // namespace thalweg::pipeline
