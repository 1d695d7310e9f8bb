// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/recipe_files.hpp>

#include <thalweg/io/gdal/access.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_keys.hpp>

#include <filesystem>
#include <variant>

namespace thalweg::pipeline {

bool is_address(std::string const& name) {
    return io::names_connection(name) || name.starts_with("/vsi");
}

std::string file_in(Recipe const& recipe, std::string const& name) {
    bool const stands_alone = name.empty() || name.front() == '/' || is_address(name);
    return recipe.folder.empty() || stands_alone ? name : recipe.folder + "/" + name;
}

namespace {

std::string absolute_file(Recipe const& recipe, std::string const& name) {
    return name.empty() || is_address(name)
               ? name
               : std::filesystem::absolute(file_in(recipe, name)).lexically_normal().string();
}

} // namespace

Recipe with_absolute_files(Recipe recipe) {
    for (Key const& key : all_keys()) {
        if (!names_file(key) || key.section() == "patch") { // whose keys reach the last patch only
            continue;
        }
        if (auto const value = key.take(recipe)) {
            std::string const& name = std::get<std::string>(*value);
            if (!name.empty()) {
                key.put(recipe, absolute_file(recipe, name));
            }
        }
    }
    for (PatchRecipe& patch : recipe.patches) {
        patch.source = absolute_file(recipe, patch.source);
        patch.mask = absolute_file(recipe, patch.mask);
    }
    recipe.folder.clear();
    return recipe;
}

Recipe framed(Recipe recipe, Grid const& grid) {
    recipe.grid.width = grid.width;
    recipe.grid.height = grid.height;
    recipe.grid.origin = {grid.west, grid.north};
    return recipe;
}

} // namespace thalweg::pipeline
