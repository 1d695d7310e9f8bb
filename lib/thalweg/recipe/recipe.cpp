// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/recipe/recipe.hpp>

#include <algorithm>

#include <fmt/format.h>

namespace thalweg::recipe {
namespace {

/// Terrain around rivers that are still to be named. Real land is not equally steep everywhere
/// (docs/relief_measures.md, slope_spread): uplift differs from place to place, its pattern by seed, and a few rivers
/// run through lakes.
Recipe recipe_around(Source source, std::int64_t width, std::int64_t height) {
    Recipe recipe;
    recipe.grid.width = width;
    recipe.grid.height = height;
    recipe.network.emplace().source = source;
    EquilibriumRecipe& land = recipe.surface.emplace().equilibrium;
    land.mean_slope_deg = 25.0;
    land.uplift_pattern = surface::UpliftPattern::seed;
    land.uplift_contrast = 6.0;
    land.lake_share = 0.05;
    return recipe;
}

constexpr std::int64_t usual_side = 1024; // [cells]

} // namespace

Recipe default_recipe() {
    return default_recipe_on(usual_side, usual_side);
}

Recipe default_recipe_on(std::int64_t width, std::int64_t height) {
    constexpr std::int64_t in_a_side = 10;
    std::int64_t const spacing = std::clamp<std::int64_t>(std::min(width, height) / in_a_side, 8, 50);
    Recipe recipe = recipe_around(Source::forest, width, height);
    recipe.network->prune_cells = static_cast<double>(2 * spacing);
    recipe.network->forest.spacing_cells = spacing;
    recipe.network->forest.outlet_spacing_cells = 16 * spacing;
    return recipe;
}

Recipe cluster_recipe() {
    Recipe recipe = recipe_around(Source::dla, usual_side, usual_side);
    NetworkRecipe& network = *recipe.network;
    network.prune_cells = 30.0;
    network.dla.particles = 100000;
    network.dla.sticking = 1.0;
    network.dla.visits = 1;
    network.branch = growth::BranchChoice::south;
    return recipe;
}

bool OutputRecipe::has(OutputFiles wanted) const {
    return !files || std::ranges::find(*files, wanted) != files->end();
}

std::string title_of(Recipe const& recipe) {
    return recipe.output.title.empty() ? fmt::format("thalweg, seed {}", recipe.seed) : recipe.output.title;
}

} // namespace thalweg::recipe
