// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/recipe/made_from.hpp>

#include <utility>

#include <fmt/format.h>

#include <thalweg/recipe/recipe_files.hpp>

namespace thalweg::recipe {
namespace {

std::string state_in_words(Recipe const& decisive) {
    return write_recipe(decisive) + state_of_files(decisive);
}

std::string state_in_words(Recipe const& decisive, bool heights_of_file) {
    return state_in_words(decisive) + (heights_of_file ? "\nheights of the file" : "");
}

/// Rebuilt terrain ends at the gaps of the DEM that it is compared with.
OutputRecipe output_of_rivers(Recipe const& recipe) {
    OutputRecipe output;
    output.against = recipe.output.against;
    return output;
}

/// A recipe without what only the surface reads.
Recipe of_rivers(Recipe recipe) {
    recipe.skeleton.reset();
    recipe.detail.reset();
    recipe.patches.clear();
    recipe.output = output_of_rivers(recipe);
    if (recipe.surface) {
        SurfaceRecipe surface;
        surface.method = recipe.surface->method;
        surface.source = recipe.surface->source; // rivers end at its holes
        if (recipe.network && recipe.network->source == Source::lines) {
            surface.equilibrium.lakes = recipe.surface->equilibrium.lakes; // and run through these
        }
        recipe.surface = std::move(surface);
    }
    return recipe;
}

} // namespace

std::string lines_made_from(Recipe const& recipe) {
    Recipe decisive;
    decisive.grid = recipe.grid;
    decisive.network.emplace().source = recipe.network->source;
    decisive.network->lines = recipe.network->lines;
    decisive.folder = recipe.folder;
    if (recipe.surface && !recipe.surface->equilibrium.lakes.empty()) {
        decisive.surface.emplace().equilibrium.lakes = recipe.surface->equilibrium.lakes;
    }
    return state_in_words(decisive) + fmt::format("\n{}", recipe.network->slope); // of lines without heights
}

std::string raster_made_from(Recipe const& recipe) {
    Recipe decisive;
    decisive.grid = recipe.grid;
    SurfaceRecipe& surface = decisive.surface.emplace();
    surface.method = recipe.surface->method;
    surface.source = recipe.surface->source;
    if (recipe.grid.crs.empty() && recipe.network && recipe.network->source == Source::lines) {
        decisive.network.emplace().source = Source::lines; // a DEM without a CRS takes theirs
        decisive.network->lines = recipe.network->lines;
    }
    decisive.folder = recipe.folder;
    return state_in_words(decisive);
}

std::string cluster_made_from(Recipe const& recipe) {
    Recipe decisive;
    decisive.seed = recipe.seed;
    decisive.network.emplace().dla = recipe.network->dla;
    return write_recipe(decisive);
}

std::string source_made_from(Recipe const& recipe, bool heights_of_file) {
    Recipe decisive = of_rivers(recipe);
    NetworkRecipe& rivers = *decisive.network;
    NetworkRecipe const standard;
    rivers.prune_cells = standard.prune_cells;
    rivers.meander = standard.meander;
    rivers.slope = standard.slope;
    rivers.concavity = standard.concavity;
    rivers.heights_tolerance_m = standard.heights_tolerance_m;
    rivers.rosgen = standard.rosgen;
    rivers.rosgen_slope = standard.rosgen_slope;
    rivers.inland = standard.inland;
    rivers.fill_space = standard.fill_space;
    rivers.support_cells = standard.support_cells;
    rivers.coast_m = standard.coast_m;
    return state_in_words(decisive, heights_of_file);
}

std::string planform_made_from(Recipe const& recipe, bool heights_of_file) {
    return state_in_words(of_rivers(recipe), heights_of_file);
}

std::string surface_made_from(Recipe const& recipe, bool heights_of_file) {
    Recipe decisive = recipe;
    decisive.patches.clear();
    decisive.output = output_of_rivers(recipe);
    if (decisive.surface) {
        decisive.surface->drain = SurfaceRecipe{}.drain;
    }
    if (decisive.network) {
        decisive.network->fill_space = NetworkRecipe{}.fill_space;
        decisive.network->support_cells = NetworkRecipe{}.support_cells;
    }
    return state_in_words(decisive, heights_of_file);
}

} // namespace thalweg::recipe
