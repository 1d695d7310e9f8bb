// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/recipe_files.hpp>

#include <thalweg/io/gdal/access.hpp>

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

std::vector<NamedFile> files_of(Recipe const& recipe) {
    std::vector<NamedFile> files;
    for (Section const& section : all_sections()) {
        std::size_t const count = section.count(recipe);
        for (std::size_t item = 0; item < count; ++item) {
            for (Key const& key : all_keys()) {
                bool const is_named = key.part == &section && key.help.is_file;
                auto const value = is_named ? key.take(recipe, item) : std::optional<Value>();
                if (value && !std::get<std::string>(*value).empty()) {
                    files.push_back({&key, item, std::get<std::string>(*value), key.layer(recipe, item)});
                }
            }
        }
    }
    return files;
}

Recipe with_absolute_files(Recipe recipe) {
    for (NamedFile const& file : files_of(recipe)) {
        if (!is_address(file.name)) {
            std::filesystem::path const path = std::filesystem::absolute(file_in(recipe, file.name));
            file.key->put(recipe, path.lexically_normal().string(), file.item);
        }
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
