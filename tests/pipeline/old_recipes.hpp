// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include <thalweg/io/files/files.hpp>
#include <thalweg/pipeline/recipe/recipe.hpp>

namespace thalweg::pipeline {

/// Five small recipes in folders of their own, of different sources and surfaces.
inline std::filesystem::path old_recipes() {
    return std::filesystem::path(THALWEG_SOURCE_DIR) / "tests/data/recipes_0_1_0";
}

inline Recipe recipe_in(std::filesystem::path const& place) {
    std::string const file = (place / "recipe.toml").string();
    Recipe recipe = read_recipe(io::read_text(file, 1 << 20), file);
    recipe.folder = place.string();
    return recipe;
}

} // namespace thalweg::pipeline
