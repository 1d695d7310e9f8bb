// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/recipe.hpp>

#include <thalweg/pipeline/recipe/internal/sections.hpp>

#include <fmt/format.h>

namespace thalweg::pipeline {

Recipe default_recipe() {
    Recipe recipe;
    recipe.grid.width = 1024;
    recipe.grid.height = 1024;
    NetworkRecipe& network = recipe.network.emplace();
    network.prune_cells = 30.0;
    network.dla.particles = 100000;
    network.dla.sticking = 1.0;
    network.dla.visits = 1;
    network.branch = network::BranchChoice::south;
    recipe.surface.emplace().equilibrium.mean_slope_deg = 25.0;
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
