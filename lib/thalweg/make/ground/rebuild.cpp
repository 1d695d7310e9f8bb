// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <utility>

#include <thalweg/make/internal/balance.hpp>
#include <thalweg/surface/equilibrium/rebuild.hpp>

// Described in docs/rebuild.md.

namespace thalweg::make {
namespace {

/// Keys that describe terrain in equilibrium keep their meaning relative to their defaults.
surface::RebuildParams rebuild_params_of(recipe::EquilibriumRecipe const& wanted,
                                         surface::EquilibriumParams const& given) {
    surface::EquilibriumParams const usual;
    surface::RebuildParams params;
    if (given.relief_m) {
        params.relief_m = given.relief_m;
    } else if (given.bring_to_target) {
        params.mean_slope_deg = given.mean_slope_deg;
    }
    params.theta = std::clamp(params.theta * given.theta / usual.theta, 0.1, 0.9);
    params.hillslope_m = wanted.hillslope_m > 0.0 ? wanted.hillslope_m : params.hillslope_m;
    params.debris_area_m2 *= given.debris_area_m2 / usual.debris_area_m2;
    params.floor_width_km = given.floor_width_km;
    params.roughness = std::min(1.0, params.roughness * given.roughness / usual.roughness);
    params.longest_wave_m *= given.longest_wave_m / usual.longest_wave_m;
    params.edge = given.edge;
    params.seed = given.seed;
    return params;
}

SolvedEquilibrium rebuilt(recipe::EquilibriumRecipe const& wanted, Channels const& channels,
                          surface::EquilibriumFields const& fields, surface::EquilibriumParams params, Run const& run) {
    params.edge = params.edge == surface::Edge::open ? surface::Edge::closed : params.edge;
    surface::RebuiltTerrain made = surface::rebuild(channels, fields, rebuild_params_of(wanted, params), run);
    return {.land = std::move(made.terrain),
            .params = params,
            .told = {{}, made.survey.source_km2, made.survey.spacing_m, made.survey.concavity, made.smooth_slope_deg},
            .findings = params.bring_to_target ? std::vector<Finding>{} : surface::doubts_of(made.survey)};
}

} // namespace

Surface rebuild(GroundInput const& in, Run const& run) {
    auto const solve = [&](Channels const& channels, surface::EquilibriumFields const& fields,
                           surface::EquilibriumParams const& params) {
        return rebuilt(in.recipe.surface->equilibrium, channels, fields, params, run);
    };
    return balanced(in, {.is_rebuilt = true, .solve = solve}, run);
}

} // namespace thalweg::make
