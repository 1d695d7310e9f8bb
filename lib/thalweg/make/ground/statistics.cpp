// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/stage_log.hpp>
#include <thalweg/make/internal/ground.hpp>
#include <thalweg/make/internal/numbers.hpp>
#include <thalweg/recipe/check_recipe.hpp>
#include <thalweg/recipe/stages.hpp>
#include <thalweg/skeleton/random_fields.hpp>
#include <thalweg/solver/statistics/field_statistics.hpp>

namespace thalweg::make {

recipe::StatisticsRecipe const& asked(recipe::Recipe const& recipe) {
    static recipe::StatisticsRecipe const nothing_asked;
    return recipe.statistics ? *recipe.statistics : nothing_asked;
}

double mean_of(recipe::StatisticsRecipe const& s) {
    if (s.mean) {
        return *s.mean;
    }
    return s.max && s.min ? 0.5 * ((*s.max)[0] + (*s.min)[0]) : 0.0;
}

solver::StableCovariance covariance_of(recipe::StatisticsRecipe const& s, double step) {
    solver::StableCovariance covariance;
    covariance.lx_cells = (s.length ? (*s.length)[0] : default_length_cells) / step;
    covariance.ly_cells = (s.length ? (*s.length)[1] : default_length_cells) / step;
    covariance.dimension = s.dimension.value_or(default_dimension);
    // Slopes are measured between neighbours: they do not apply to coarser cells.
    return s.slope && step == 1.0 ? solver::with_slope(covariance, s.std.value_or(default_std_m), *s.slope)
                                  : covariance;
}

namespace {

Raster<float> drawn_to_extremes(Raster<float> land, recipe::StatisticsRecipe const& s, int levels) {
    double const step = static_cast<double>(std::int64_t{1} << levels);
    for (auto const& extreme : {s.max, s.min}) {
        if (!extreme || s.reach_cells <= 0.0) {
            continue;
        }
        auto const nearest = [&](double fine, std::int64_t side) {
            return std::min(side - 1, static_cast<std::int64_t>(std::floor(fine / step + 0.5)));
        };
        Cell const centre{nearest((*extreme)[1], land.width()), nearest((*extreme)[2], land.height())};
        land =
            skeleton::attract(std::move(land), {centre, (*extreme)[0], std::max(1.0, s.reach_cells / step), s.falloff});
    }
    return s.mean ? skeleton::shift_mean(std::move(land), *s.mean) : land;
}

} // namespace

Raster<float> random_land(recipe::Recipe const& recipe, recipe::Prior prior, Grid const& coarse, int levels,
                          Run const& run) {
    recipe::StatisticsRecipe const& s = asked(recipe);
    double const step = static_cast<double>(std::int64_t{1} << levels);
    double const lx = (s.length ? (*s.length)[0] : default_length_cells) / step;
    double const ly = (s.length ? (*s.length)[1] : default_length_cells) / step;
    double const std = s.std.value_or(default_std_m);
    skeleton::FieldParams const field{mean_of(s), std, lx, ly, recipe.seed};
    switch (prior) {
    case recipe::Prior::separable: return drawn_to_extremes(skeleton::separable_ar(coarse, field, run), s, levels);
    case recipe::Prior::markov3: return drawn_to_extremes(skeleton::markov3(coarse, field, run), s, levels);
    default: break;
    }
    skeleton::GrfParams params;
    params.mean = mean_of(s);
    params.std = std;
    params.covariance = covariance_of(s, step);
    params.seed = recipe.seed;
    return skeleton::grf(coarse, params, run).dem;
}

Surface statistics(GroundInput const& in, Run const& run) {
    StageLog stage_log(run);
    Raster<float> dem = stage_log.stage(recipe::stage::land.name, [&] {
        return random_land(in.recipe, in.recipe.statistics->skeleton, in.grid, recipe::levels_of(in.recipe), run);
    });
    stage_log.say(fmt::format("random, {}x{} cells of {} m", in.grid.width, in.grid.height, in.grid.cell_m));
    return {.ground = {.dem = std::move(dem), .how = OfNumbers{}},
            .notes = {{}, stage_log.take_findings(), stage_log.take()}};
}

} // namespace thalweg::make
