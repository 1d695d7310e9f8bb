// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/internal/land_parts.hpp>

#include <thalweg/skeleton/random_fields.hpp>
#include <thalweg/skeleton/scatter.hpp>
#include <thalweg/solver/statistics/field_statistics.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace thalweg::pipeline {

namespace {

Raster<float> drawn_to_extremes(Raster<float> land, StatisticsRecipe const& s, int levels) {
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

StatisticsRecipe const& asked(Recipe const& recipe) {
    static StatisticsRecipe const nothing_asked;
    return recipe.statistics ? *recipe.statistics : nothing_asked;
}

double mean_of(StatisticsRecipe const& s) {
    if (s.mean) {
        return *s.mean;
    }
    return s.max && s.min ? 0.5 * ((*s.max)[0] + (*s.min)[0]) : 0.0;
}

solver::StableCovariance covariance_of(StatisticsRecipe const& s, double step) {
    solver::StableCovariance covariance;
    covariance.lx_cells = (s.length ? (*s.length)[0] : default_length_cells) / step;
    covariance.ly_cells = (s.length ? (*s.length)[1] : default_length_cells) / step;
    covariance.dimension = s.dimension.value_or(default_dimension);
    // Slopes are counted between neighbours: they say nothing of coarser cells.
    return s.slope && step == 1.0 ? solver::with_slope(covariance, s.std.value_or(default_std_m), *s.slope)
                                  : covariance;
}

Raster<float> random_land(Recipe const& recipe, Prior prior, Grid const& coarse, int levels, Run const& run) {
    StatisticsRecipe const& s = asked(recipe);
    double const step = static_cast<double>(std::int64_t{1} << levels);
    double const lx = (s.length ? (*s.length)[0] : default_length_cells) / step;
    double const ly = (s.length ? (*s.length)[1] : default_length_cells) / step;
    double const std = s.std.value_or(default_std_m);
    skeleton::FieldParams const field{mean_of(s), std, lx, ly, recipe.seed};
    switch (prior) {
    case Prior::separable: return drawn_to_extremes(skeleton::separable_ar(coarse, field, run), s, levels);
    case Prior::markov3: return drawn_to_extremes(skeleton::markov3(coarse, field, run), s, levels);
    default: break;
    }
    skeleton::GrfParams params;
    params.mean = mean_of(s);
    params.std = std;
    params.covariance = covariance_of(s, step);
    params.seed = recipe.seed;
    return skeleton::grf(coarse, params, run).dem;
}

} // namespace thalweg::pipeline
