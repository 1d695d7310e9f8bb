// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/internal/terrain.hpp>

#include <thalweg/fractal/midpoint.hpp>
#include <thalweg/pipeline/make/internal/land_parts.hpp>
#include <thalweg/pipeline/recipe/internal/check_recipe.hpp>

#include <algorithm>
#include <utility>

namespace thalweg::pipeline {

namespace {

Detailed displaced(fractal::MidpointParams params, std::uint64_t seed, Raster<float> const& coarse, Grid const& grid,
                   Run const& run) {
    params.width = grid.width;
    params.height = grid.height;
    params.seed = seed;
    fractal::Displaced const made = fractal::midpoint(coarse, params, run);
    Raster<float> land(grid); // the very frame, not one reckoned back from the coarse cells
    std::copy(made.dem.values().begin(), made.dem.values().end(), land.values().begin());
    return {{made.hurst, made.sigma}, std::move(land)};
}

} // namespace

Detailed with_detail(Plan const& plan, Raster<float> const& coarse, Grid const& grid, Run const& run) {
    return displaced(plan.recipe.detail->midpoint, plan.recipe.seed, coarse, grid, run);
}

Detailed detail_alone(Plan const& plan, Grid const& grid, Run const& run) {
    fractal::MidpointParams wanted = plan.recipe.detail->midpoint;
    wanted.hurst = wanted.hurst.value_or(3.0 - default_dimension);
    Raster<float> const flat(coarse_grid(grid, levels_of(plan.recipe)), 0.0F);
    return displaced(wanted, plan.recipe.seed, flat, grid, run);
}

} // namespace thalweg::pipeline
