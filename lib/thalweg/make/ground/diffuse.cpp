// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include <fmt/format.h>

#include <thalweg/make/internal/between_rivers.hpp>
#include <thalweg/recipe/stages.hpp>
#include <thalweg/skeleton/draw_skeleton.hpp>
#include <thalweg/skeleton/midpoint_inverse.hpp>
#include <thalweg/surface/diffusion/diffusion.hpp>

namespace thalweg::make {
namespace {

/// What a surface is diffused from: rivers, ridges, points, and what follows from them beside them.
Skeleton gathered_skeleton(recipe::Recipe const& recipe, Between const& between, Run const& run) {
    recipe::SkeletonRecipe const wanted = recipe.skeleton.value_or(recipe::SkeletonRecipe{});
    skeleton::DrawSkeletonParams params;
    params.noise.amplitude_m = wanted.ridge_noise_m;
    params.noise.wavelength_m = wanted.ridge_wavelength_m;
    params.noise.seed = recipe.seed;
    Skeleton skeleton =
        skeleton::draw_skeleton({between.valley.raster()}, between.ridges, between.points, params, run).skeleton;
    if (wanted.midpoint_inverse_cells > 0.0) {
        skeleton = skeleton::midpoint_inverse(skeleton, {wanted.midpoint_inverse_cells}, run);
    }
    return skeleton;
}

} // namespace

Surface diffuse(GroundInput const& in, Run const& run) {
    StageLog stage_log(run);
    Between between = between_rivers(in, stage_log, run);
    if (between.is_whole) {
        between.inside = {}; // no mask: everywhere
    }
    surface::DiffusedDem made = stage_log.stage(recipe::stage::fill.name, [&] {
        surface::DiffuseParams params = in.recipe.surface->diffuse;
        params.seed = in.recipe.seed;
        params.tolerance = in.recipe.surface->tolerance.value_or(params.tolerance);
        return surface::diffuse(gathered_skeleton(in.recipe, between, run), between.inside, params, run);
    });
    stage_log.say(fmt::format("{}x{}, diffused, {} iterations", in.grid.width, in.grid.height, made.iterations));
    return surface_between(in, std::move(between), std::move(made.dem), ByDiffusion{made.iterations, made.residual}, {},
                           stage_log);
}

} // namespace thalweg::make
