// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <thalweg/io/files/files.hpp>
#include <thalweg/recipe/recipe.hpp>

namespace thalweg::recipe {

/// Five small recipes in folders of their own, of different sources and surfaces.
inline std::filesystem::path const old_recipes = THALWEG_SOURCE_DIR "/tests/data/recipes_0_1_0";

inline std::vector<std::string> old_recipe_names() {
    std::vector<std::string> names;
    for (std::filesystem::directory_entry const& entry : std::filesystem::directory_iterator(old_recipes)) {
        if (entry.is_directory()) {
            names.push_back(entry.path().filename().string());
        }
    }
    std::ranges::sort(names);
    return names;
}

inline recipe::Recipe old_recipe(std::string const& name) {
    std::string const file = (old_recipes / name / "recipe.toml").string();
    recipe::Recipe recipe = recipe::read_recipe(io::read_text(file, 1 << 20), file);
    recipe.folder = (old_recipes / name).string();
    return recipe;
}

} // namespace thalweg::recipe
