// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/user_files.hpp>

#include <thalweg/io/gdal/access.hpp>
#include <thalweg/io/gdal/sources.hpp>
#include <thalweg/io/mesh/points.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_files.hpp>

#include <fmt/format.h>

#include <filesystem>

namespace thalweg::pipeline {

namespace {

namespace fs = std::filesystem;

bool is_users(Recipe const& recipe, std::string const& path) {
    auto const at = recipe.set_at.find(path);
    return at == recipe.set_at.end() || at->second == "--set";
}

} // namespace

UserFiles::UserFiles(Recipe& recipe, Run const& run) {
    for (NamedFile const& file : files_of(recipe)) {
        if (is_users(recipe, file.key->place(file.item))) {
            file.key->put(recipe, copied(recipe, file.name, file.layer, run), file.item);
        }
    }
}

std::string UserFiles::copied(Recipe const& recipe, std::string const& name, std::string const& layer, Run const& run) {
    std::string const path = file_in(recipe, name);
    std::error_code ignored;
    bool const is_missing = !io::names_connection(path) && !fs::exists(path, ignored) && !path.starts_with("/vsi");
    if (name.empty() || is_missing || io::is_text_of_points(path) || io::is_recipe_file(path)) {
        return name; // what is missing is reported by the stage that needs it
    }
    if (!folder_) {
        folder_ = std::make_unique<io::TemporaryFolder>("thalweg-inputs");
    }
    fs::path const own = folder_->path() / fmt::format("{}", ++copies_);
    fs::create_directory(own);
    return io::plain_copy(path, layer, own.string(), run);
}

} // namespace thalweg::pipeline
