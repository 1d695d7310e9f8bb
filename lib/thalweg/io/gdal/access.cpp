// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/gdal/access.hpp>

#include <array>
#include <atomic>
#include <filesystem>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/files/files.hpp>

namespace thalweg::io {

namespace {

std::atomic<int> recipes{0};

} // namespace

bool names_connection(std::string const& path) {
    static constexpr std::array local{"/vsimem/", "/vsizip/", "/vsigzip/", "/vsitar/", "/vsisubfile/", "/vsisparse/"};
    std::string_view const name = path;
    if (name.starts_with("PG:") || name.starts_with("postgresql:") || name.starts_with("postgres:")) {
        return true;
    }
    if (!name.starts_with("/vsi")) {
        return false;
    }
    for (std::string_view const system : local) {
        if (name.starts_with(system)) { // in which another may be: /vsizip//vsicurl/...
            return names_connection(std::string(name.substr(system.size() - 1)));
        }
    }
    std::error_code ignored;
    return !std::filesystem::exists(path, ignored);
}

RecipeFiles::RecipeFiles() {
    ++recipes;
}

RecipeFiles::~RecipeFiles() {
    --recipes;
}

bool reads_recipe_files() {
    return recipes > 0;
}

void require_allowed(std::string const& path) {
    if (!reads_recipe_files()) {
        return;
    }
    if (names_connection(path)) {
        throw BadInput(fmt::format("io.require_allowed: a recipe names files, and '{}' is a connection: name it on the "
                                   "command line, or convert it to a file (ogr2ogr)",
                                   path));
    }
    refuse_pipe(path, "io.require_allowed: " + path);
    std::error_code ignored;
    auto const status = std::filesystem::status(path, ignored);
    if (!std::filesystem::exists(status)) {
        throw BadInput(fmt::format("io.require_allowed: there is no file '{}'", path));
    }
    if (!std::filesystem::is_regular_file(status) && !std::filesystem::is_directory(status)) {
        throw BadInput(fmt::format("io.require_allowed: {} is neither a file nor a folder", path));
    }
}

} // namespace thalweg::io
