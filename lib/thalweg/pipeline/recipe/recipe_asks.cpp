// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/recipe_asks.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/fractal/estimate_fractal.hpp>
#include <thalweg/fractal/midpoint.hpp>
#include <thalweg/solver/spectral/circulant.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace thalweg::pipeline {

bool in_equilibrium(Recipe const& recipe) {
    return recipe.network && recipe.surface && recipe.surface->method == Method::equilibrium;
}

bool replaces_rivers(Recipe const& recipe) {
    return std::any_of(recipe.patches.begin(), recipe.patches.end(),
                       [](PatchRecipe const& p) { return p.rivers == PatchRivers::replace; });
}

int levels_of(Recipe const& recipe) {
    return recipe.detail && recipe.detail->method == DetailMethod::midpoint ? recipe.detail->midpoint.levels : 0;
}

Grid coarse_grid(Grid const& grid, int levels) {
    std::int64_t const step = std::int64_t{1} << levels;
    Grid coarse = grid;
    coarse.width = (grid.width - 1 + step - 1) / step + 1;
    coarse.height = (grid.height - 1 + step - 1) / step + 1;
    coarse.cell_m = grid.cell_m * static_cast<double>(step);
    double const shift = 0.5 * (coarse.cell_m - grid.cell_m);
    coarse.west = grid.west - shift;
    coarse.north = grid.north + shift;
    return coarse;
}

void check_detail(Recipe const& recipe, std::int64_t width, std::int64_t height) {
    int const levels = levels_of(recipe);
    if (levels == 0 || recipe.detail->midpoint.stencil != fractal::Stencil::exact) {
        return;
    }
    auto const coarse_at = [&](int halved) { return coarse_grid({width, height, 1.0, 0.0, 0.0, ""}, halved); };
    auto const coarse_cells = [&](int halved) { return coarse_at(halved).cells(); };
    if (coarse_cells(levels) <= fractal::most_conditioning_cells) {
        Grid const coarse = coarse_at(levels);
        solver::check_fractional_surface(((coarse.width - 1) << levels) + 1, ((coarse.height - 1) << levels) + 1,
                                         recipe.detail->midpoint.hurst.value_or(fractal::least_hurst));
        return;
    }
    constexpr int most_levels = 12;
    int enough = levels;
    while (enough <= most_levels && coarse_cells(enough) > fractal::most_conditioning_cells) {
        ++enough;
    }
    throw BadParameter(fmt::format(
        "pipeline.check_detail: detail.stencil = \"exact\" takes up to {} coarse cells, and {} x {} cells at "
        "detail.levels = {} have {}; set {}detail.stencil = 16",
        fractal::most_conditioning_cells, width, height, levels, coarse_cells(levels),
        enough <= most_levels ? fmt::format("detail.levels = {}, or ", enough) : ""));
}

} // namespace thalweg::pipeline
