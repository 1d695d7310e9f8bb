// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/recipe/stage_recipes.hpp>

#include <utility>

#include <fmt/format.h>

#include <thalweg/recipe/condition.hpp>
#include <thalweg/recipe/recipe_files.hpp>
#include <thalweg/recipe/recipe_keys.hpp>

namespace thalweg::recipe {
namespace {

/// A recipe without any key, in the folder of another.
Recipe in_folder_of(Recipe const& recipe) {
    Recipe none;
    none.folder = recipe.folder;
    none.copy_of = recipe.copy_of;
    return none;
}

/// Rebuilt terrain ends at the gaps of the DEM that it is compared with.
OutputRecipe output_of_rivers(Recipe const& recipe) {
    OutputRecipe output;
    output.against = recipe.output.against;
    return output;
}

} // namespace

Recipe recipe_for_lines(Recipe const& recipe) {
    Recipe read = in_folder_of(recipe);
    read.grid = recipe.grid;
    NetworkRecipe& rivers = read.network.emplace();
    rivers.source = recipe.network->source;
    rivers.lines = recipe.network->lines;
    rivers.slope = recipe.network->slope; // of lines without heights
    if (recipe.surface) {
        read.surface.emplace().equilibrium.lakes = recipe.surface->equilibrium.lakes;
    }
    return read;
}

Recipe recipe_for_raster(Recipe const& recipe) {
    Recipe read = in_folder_of(recipe);
    if (recipe.grid.crs.empty() && from_lines(recipe)) {
        read = recipe_for_lines(recipe); // a DEM without a CRS takes theirs
    }
    read.grid = recipe.grid;
    SurfaceRecipe& surface = read.surface.emplace();
    surface.method = recipe.surface->method;
    surface.source = recipe.surface->source;
    return read;
}

Recipe recipe_for_cluster(Recipe const& recipe) {
    Recipe read;
    read.seed = recipe.seed;
    read.network.emplace().dla = recipe.network->dla;
    return read;
}

Recipe recipe_for_source(Recipe const& recipe) {
    Recipe read = recipe_for_planform(recipe);
    NetworkRecipe& rivers = *read.network;
    NetworkRecipe const standard;
    rivers.prune_cells = standard.prune_cells;
    rivers.meander = standard.meander;
    // Of lines missing heights follow from the slope, and what becomes of lakes from the ends inland.
    if (rivers.source != Source::lines) {
        rivers.slope = standard.slope;
        rivers.inland = standard.inland;
    }
    rivers.concavity = standard.concavity;
    rivers.heights_tolerance_m = standard.heights_tolerance_m;
    rivers.rosgen = standard.rosgen;
    rivers.rosgen_slope = standard.rosgen_slope;
    rivers.fill_space = standard.fill_space;
    rivers.support_cells = standard.support_cells;
    rivers.coast_m = standard.coast_m;
    return read;
}

Recipe recipe_for_planform(Recipe const& recipe) {
    Recipe read = recipe;
    read.skeleton.reset();
    read.strata.reset();
    read.layers.clear();
    read.detail.reset();
    read.patches.clear();
    read.output = output_of_rivers(recipe);
    if (recipe.surface) {
        SurfaceRecipe& surface = read.surface.emplace();
        surface.method = recipe.surface->method;
        surface.source = recipe.surface->source; // rivers end at its holes
        if (from_lines(recipe)) {
            surface.equilibrium.lakes = recipe.surface->equilibrium.lakes; // and run through these
        }
    }
    return read;
}

Recipe recipe_for_surface(Recipe const& recipe) {
    Recipe read = recipe;
    read.patches.clear();
    read.output = output_of_rivers(recipe);
    if (read.surface) {
        read.surface->drain = SurfaceRecipe{}.drain;
    }
    if (read.network) {
        read.network->fill_space = NetworkRecipe{}.fill_space;
        read.network->support_cells = NetworkRecipe{}.support_cells;
    }
    return read;
}

std::string cache_key(Recipe const& recipe) {
    std::string text;
    for (Key const& key : all_keys()) {
        for (Item item = 0; item < key.part->count(recipe); ++item) {
            if (auto const value = key.take(recipe, item)) {
                text += fmt::format("{} = {}\n", key.place(item), toml_text(*value));
            }
        }
    }
    return text + state_of_files(recipe);
}

} // namespace thalweg::recipe
