// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/make/internal/between_rivers.hpp>
#include <thalweg/recipe/stages.hpp>
#include <thalweg/surface/diffusion/diffusion.hpp>
#include <thalweg/surface/dilation/dilation.hpp>
#include <thalweg/surface/equilibrium/features.hpp>

namespace thalweg::make {
namespace {

void warn_of_jumps(std::int64_t levels, surface::IncrementParams const& params, StageLog& stage_log) {
    auto const jumps = surface::increment_jumps(levels, params);
    if (!jumps.empty()) {
        stage_log.find(
            {.kind = "jumping_increment",
             .amount = jumps[0].to - jumps[0].from,
             .text = fmt::format("surface.increment = \"{}\" jumps from {:.3g} to {:.3g} at x = {:.4g}{}: slopes break "
                                 "there",
                                 params.increment, jumps[0].from, jumps[0].to, jumps[0].x,
                                 jumps.size() > 1 ? fmt::format(", and {} times more", jumps.size() - 1) : ""),
             .key = "surface.increment",
             .numbers = {{"jumps", static_cast<double>(jumps.size())}, {"x", jumps[0].x}}});
    }
}

/// A surface that passes through given points between rivers; random ones shape only what it rises from.
Raster<float> through_points(Raster<float> dem, Between const& between, Run const& run) {
    if (between.through.points.empty()) {
        return dem;
    }
    Grid const& grid = dem.grid();
    std::map<std::int64_t, float> highest;
    for (Vec3 const& p : between.through.points) {
        auto const [place, is_new] = highest.try_emplace(grid.index(grid.cell_of(in_plan(p))), static_cast<float>(p.z));
        place->second = std::max(place->second, static_cast<float>(p.z));
    }
    std::vector<surface::FeatureCell> cells;
    for (auto const& [cell, z] : highest) {
        cells.push_back({cell, z});
    }
    return surface::through_heights(std::move(dem), between.valley.cell, cells, run);
}

surface::DilatedDem dilated_on(recipe::SurfaceRecipe const& wanted, Between const& between, Run const& run) {
    if (wanted.base == recipe::Base::paper) { // without a mask by the closed form
        Valley const valley{between.valley.raster()};
        return between.is_whole ? surface::dilate(valley, wanted.dilate, run)
                                : surface::dilate(valley, between.inside, wanted.dilate, run);
    }
    surface::HarmonicParams params;
    params.tolerance = wanted.tolerance.value_or(params.tolerance);
    Raster<float> const base = wanted.base == recipe::Base::tin
                                   ? over_triangles(between, run)
                                   : surface::harmonic({between.valley.raster()}, between.inside, params, run);
    Valley const valley{between.valley.raster()};
    return between.is_whole ? surface::dilate_over(valley, base, wanted.dilate, run)
                            : surface::dilate_over(valley, base, between.inside, wanted.dilate, run);
}

surface::DilatedDem dilated(recipe::SurfaceRecipe const& wanted, Between const& between, Run const& run) {
    try {
        return dilated_on(wanted, between, run);
    } catch (BadParameter const& fault) { // how many levels there are is known only now
        bool const is_increment = std::string_view(fault.where()) == "surface.increments";
        throw BadParameter(fault.where(),
                           fmt::format("{}{}", is_increment ? "[surface] increment: " : "", fault.what()));
    }
}

/// Checks that slopes rise as high above their rivers as the recipe asks.
std::vector<Check> relief_checks(double asked, double rise_m) {
    constexpr double allowed = 0.01;
    if (!(asked > 0.0)) {
        return {};
    }
    double const error = std::fabs(rise_m / asked - 1.0);
    return {{"relief_error", error, allowed, error <= allowed}};
}

} // namespace

Surface dilate(GroundInput const& in, Run const& run) {
    StageLog stage_log(run);
    Between between = between_rivers(in, stage_log, run);
    if (between.is_whole) {
        between.inside = {}; // no mask: everywhere
    }
    recipe::SurfaceRecipe const& wanted = *in.recipe.surface;
    surface::DilatedDem made = stage_log.stage(recipe::stage::fill_dilated.name, [&] {
        surface::DilatedDem rising = dilated(wanted, between, run);
        rising.dem = through_points(std::move(rising.dem), between, run);
        return rising;
    });
    stage_log.say(fmt::format("{}x{}, {}, {} levels", in.grid.width, in.grid.height, wanted.dilate.increment.increment,
                              made.levels));
    warn_of_jumps(made.levels, wanted.dilate.increment, stage_log);
    std::vector<Check> const checks = relief_checks(wanted.dilate.relief_m, made.rise_m);
    return surface_between(in, std::move(between), std::move(made.dem),
                           ByDilation{std::move(made.increments), made.levels, made.rise_m, made.flat_share}, checks,
                           stage_log);
}

} // namespace thalweg::make
