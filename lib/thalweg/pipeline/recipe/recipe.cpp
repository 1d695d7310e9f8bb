// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/recipe.hpp>

#include <thalweg/pipeline/recipe/internal/sections.hpp>

#include <fmt/format.h>

namespace thalweg::pipeline {

namespace {

/// Terrain of 1024 x 1024 cells, around rivers that are still to be named.
Recipe recipe_around(Source source, double prune_cells) {
    Recipe recipe;
    recipe.grid.width = 1024;
    recipe.grid.height = 1024;
    recipe.network.emplace().source = source;
    recipe.network->prune_cells = prune_cells;
    recipe.surface.emplace().equilibrium.mean_slope_deg = 25.0;
    return recipe;
}

} // namespace

Recipe default_recipe() {
    Recipe recipe = recipe_around(Source::forest, 100.0);
    recipe.network->forest.spacing_cells = 50;
    recipe.network->forest.outlet_spacing_cells = 600;
    return recipe;
}

Recipe cluster_recipe() {
    Recipe recipe = recipe_around(Source::dla, 30.0);
    NetworkRecipe& network = *recipe.network;
    network.dla.particles = 100000;
    network.dla.sticking = 1.0;
    network.dla.visits = 1;
    network.branch = network::BranchChoice::south;
    return recipe;
}

std::string title_of(Recipe const& recipe) {
    return recipe.output.title.empty() ? fmt::format("thalweg, seed {}", recipe.seed) : recipe.output.title;
}

Rows<Recipe> seed_keys() {
    return {
        number("seed", &Recipe::seed)
            .range({0, endless})
            .means("random seed of the whole recipe; recorded in the network's run table and, without output.title, in "
                   "the titles"),
    };
}

} // namespace thalweg::pipeline
