// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/recipe/make_input.hpp>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/gdal/access.hpp>
#include <thalweg/io/network/read_rivers.hpp>
#include <thalweg/io/sources/sources.hpp>
#include <thalweg/recipe/check_recipe.hpp>
#include <thalweg/recipe/condition.hpp>
#include <thalweg/recipe/read_inputs.hpp>
#include <thalweg/recipe/recipe_files.hpp>

namespace thalweg::recipe {

namespace {

namespace fs = std::filesystem;

bool has_toml_name(std::string const& path) {
    std::string ending = fs::path(path).extension().string();
    std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending == ".toml";
}

bool is_word(std::string_view text) {
    return !text.empty() && std::ranges::all_of(text, [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.' || c == ' ';
    });
}

/// Whether the first line that is not empty or a comment is a section or an assignment.
bool begins_like_toml(std::string const& path) {
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) {
        return false;
    }
    std::ifstream file(path, std::ios::binary);
    std::string text(65536, '\0');
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(file.gcount()));
    for (std::size_t begin = 0; begin < text.size();) {
        std::size_t const end = std::min(text.find('\n', begin), text.size());
        std::string_view line(text.data() + begin, end - begin);
        begin = end + 1;
        line.remove_prefix(std::min(line.find_first_not_of(" \t\r"), line.size()));
        if (line.empty() || line.front() == '#') {
            continue;
        }
        if (line.front() == '[') {
            line.remove_prefix(line.size() > 1 && line[1] == '[' ? 2 : 1);
            auto const close = line.find(']');
            return close != std::string_view::npos && is_word(line.substr(0, close));
        }
        return is_word(line.substr(0, line.find('='))) && line.find('=') != std::string_view::npos;
    }
    return false;
}

/// The title of terrain with the rivers of a path.
std::string title_of_path(std::string const& path) {
    if (io::names_connection(path)) { // it may contain a password
        return "rivers";
    }
    fs::path at = fs::path(path).lexically_normal();
    at = at.has_filename() ? at : at.parent_path();
    std::error_code ignored;
    std::string const name = (fs::is_directory(at, ignored) ? at.filename() : at.stem()).string();
    return is_utf8(name) ? name : "rivers";
}

bool is_raster(std::string const& path) {
    std::error_code ignored;
    try {
        return !fs::is_directory(path, ignored) && io::content_of(path).kind == io::FileContent::Kind::raster;
    } catch (BadInput const&) { // it holds nothing of use
        return false;
    }
}

} // namespace

Recipe rivers_recipe(std::string const& path) {
    io::RiverSource const source = io::find_rivers(path);
    Recipe recipe;
    recipe.grid.cell_m = 0.0;
    NetworkRecipe& network = recipe.network.emplace();
    network.source = Source::lines;
    network.lines.path = source.path;
    network.lines.layer = source.layer;
    recipe.surface.emplace();
    recipe.output.title = title_of_path(path);
    return recipe;
}

Recipe raster_recipe(std::string const& path) {
    Recipe recipe;
    recipe.grid.cell_m = 0.0;
    SurfaceRecipe& surface = recipe.surface.emplace();
    surface.method = Method::raster;
    surface.source = path;
    recipe.output.title = title_of_path(path);
    return recipe;
}

Recipe data_recipe(std::string const& path) {
    try {
        return rivers_recipe(path);
    } catch (BadInput const&) {
        if (is_raster(path)) {
            return raster_recipe(path);
        }
        throw;
    }
}

Recipe recipe_from(std::string const& path) {
    if (!has_toml_name(path) && !begins_like_toml(path)) {
        try {
            return data_recipe(path);
        } catch (BadInput const& why) {
            throw BadInput(
                "recipe.recipe_from",
                fmt::format(
                    "{}; give a recipe (TOML), a DEM, a file of river lines, or a folder that make or convert wrote",
                    why.what()));
        }
    }
    Recipe recipe = read_recipe(io::read_text(path, 2 << 20), path);
    recipe.folder = fs::path(path).parent_path().string();
    return recipe;
}

Recipe rebuild_recipe(Recipe recipe, Run const& run) {
    refuse_if<BadInput>(!from_lines(recipe), "recipe.rebuild_recipe",
                        "there are no rivers of a file: name a file of lines with heights");
    if (!recipe.surface) {
        recipe.surface.emplace();
    }
    recipe.surface->method = Method::equilibrium;
    if (recipe.network->heights == Heights::automatic) {
        recipe.network->heights = Heights::file;
    }
    return recipe.output.against.empty() ? recipe : on_grid_of_against(std::move(recipe), run);
}

Recipe settled_recipe(Recipe const& wanted, Run const& run) {
    check_recipe(wanted);
    OnRaster const on = on_raster(wanted) ? settle_on_raster(wanted, run) : OnRaster{wanted.grid};
    StageLog stage_log(run);
    stage_log.find(on.findings);
    Recipe settled = wanted;
    settled.grid = on.grid;
    if (from_lines(wanted)) {
        RiverLines const lines = read_lines(settled, run);
        stage_log.find(lines.findings);
        settled = settle_on_lines(std::move(settled), lines, stage_log, run).recipe;
    }
    run.report(stage_log.take_findings());
    return with_absolute_files(std::move(settled));
}

} // namespace thalweg::recipe
