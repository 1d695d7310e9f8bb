// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/recipe/recipe_files.hpp>

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <thalweg/core/append.hpp>
#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/run/result_cache.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/gdal/access.hpp>
#include <thalweg/io/mesh/points.hpp>
#include <thalweg/io/raster/heightmap.hpp>
#include <thalweg/io/sources/sources.hpp>

namespace thalweg::recipe {

bool is_address(std::string const& name) {
    return io::names_connection(name) || name.starts_with("/vsi");
}

io::Source file_in(Recipe const& recipe, std::string const& name) {
    bool const stands_alone = name.empty() || name.front() == '/' || is_address(name);
    io::Source source(recipe.folder.empty() || stands_alone ? name : recipe.folder + "/" + name, io::Access::recipe);
    auto const original = recipe.copy_of.find(source.path);
    source.shown = original == recipe.copy_of.end() ? "" : original->second;
    return source;
}

namespace {

std::string layer_of(Key const& key, Recipe const& recipe, Item item) {
    char const* const path = key.row->extra.layer;
    return path == nullptr ? "" : std::get<std::string>(*find_key(path)->take(recipe, item));
}

/// Far from its central meridian a UTM zone measures other lengths than the ground has, as other projections do.
std::vector<Finding> stretch_of(Grid const& grid) {
    constexpr double much = 0.01;
    constexpr double percent = 100.0;
    if (io::is_distorted(grid) && !io::utm_number(grid.crs)) {
        io::GroundCell const ground = io::ground_cell(grid);
        double const metre = ground.side_m / grid.cell_m;
        return {
            {.kind = "stretched",
             .amount = 1.0 / metre - 1.0,
             .text = fmt::format("metres of the grid's CRS, {:.60}, are {:.3g} m on the ground there", grid.crs, metre),
             .remedy = fmt::format("Name another CRS: --crs {:.60}", ground.crs),
             .key = "grid.crs"}};
    }
    double const stretch = io::zone_stretch(grid);
    if (!(stretch > much)) {
        return {};
    }
    return {{.kind = "stretched",
             .amount = stretch,
             .text = fmt::format("the grid reaches far beyond its UTM zone {}: lengths are up to {:.1f} % too long "
                                 "there",
                                 grid.crs, percent * stretch),
             .remedy = "Name another CRS: --crs EPSG:n",
             .key = "grid.crs"}};
}

namespace fs = std::filesystem;

bool is_users(Recipe const& recipe, std::string const& path) {
    auto const at = recipe.set_at.find(path);
    return at == recipe.set_at.end() || at->second == "--set";
}

/// A file name as TOML and JSON can contain it.
std::string name_in_utf8(std::string name) {
    if (!is_utf8(name)) {
        std::ranges::replace_if(
            name, [](char c) { return static_cast<unsigned char>(c) >= 0x80U; }, '_');
    }
    return name;
}

/// Copies a named input and its companions into a folder of the output.
/// \return its new name
std::string keep_input(io::OutputFolder const& out, std::string const& folder, std::string const& name,
                       std::string const& into) {
    fs::path const given(name);
    fs::path const path = folder.empty() || given.is_absolute() ? given : fs::path(folder) / given;
    bool const is_points = io::is_text_of_points(path.string()) || io::is_point_cloud(path.string());
    std::vector<std::string> const files =
        is_points ? std::vector<std::string>{path.string()} : io::dataset_files({path.string(), io::Access::recipe});
    std::string const own = name_in_utf8(path.filename().string());
    std::string const place = into + (fs::is_directory(path) ? own + "/" : "");
    for (std::string const& file : files) {
        if (fs::is_regular_file(file)) {
            io::copy_file(file, out.path(place + name_in_utf8(fs::path(file).filename().string())));
        }
    }
    return into + own;
}

/// Whether a recipe may name a file as it is.
bool is_plain(std::string const& path) {
    return io::is_text_of_points(path) || io::is_point_cloud(path) || io::is_heightmap_file(path) ||
           io::is_recipe_file(path);
}

/// Sizes and times of a file and of those beside it that have its name ("dem.tif.aux.xml"), or of all in a folder.
std::string state_of(fs::path const& path) {
    std::error_code error;
    std::vector<std::string> parts;
    bool const is_folder = fs::is_directory(path, error);
    std::string const beginning = path.stem().string() + ".";
    for (fs::directory_entry const& one : fs::directory_iterator(is_folder ? path : path.parent_path(), error)) {
        std::error_code unknown;
        bool const belongs = is_folder || one.path().filename().string().starts_with(beginning) || one.path() == path;
        if (belongs && one.is_regular_file(unknown)) {
            parts.push_back(fmt::format("{} {} {}", one.path().string(), one.file_size(unknown),
                                        one.last_write_time(unknown).time_since_epoch().count()));
        }
    }
    std::ranges::sort(parts);
    return fmt::format("{}\n", fmt::join(parts, "\n"));
}

} // namespace

std::vector<NamedFile> files_of(Recipe const& recipe) {
    std::vector<NamedFile> files;
    for (Section const& section : all_sections()) {
        std::size_t const count = section.count(recipe);
        for (std::size_t item = 0; item < count; ++item) {
            for (Key const& key : all_keys()) {
                bool const is_named = key.part == &section && key.help.is_file;
                auto const value = is_named ? key.take(recipe, item) : std::optional<Value>();
                if (value && !std::get<std::string>(*value).empty()) {
                    files.push_back({&key, item, std::get<std::string>(*value), layer_of(key, recipe, item)});
                }
            }
        }
    }
    return files;
}

Recipe with_absolute_files(Recipe recipe) {
    for (NamedFile const& file : files_of(recipe)) {
        if (!is_address(file.name)) {
            std::filesystem::path const path = std::filesystem::absolute(file_in(recipe, file.name).path);
            file.key->put(recipe, path.lexically_normal().string(), file.item);
        }
    }
    recipe.folder.clear();
    return recipe;
}

std::vector<Finding> conversions(Recipe const& recipe, Grid const& grid, Run const& run) {
    std::vector<NamedFile> const files = files_of(recipe);
    std::string const lines_crs = recipe.network ? recipe.network->lines.source_crs : "";
    auto const made_from = [&] {
        std::string text = fmt::format("{}\n{} {} {} {} {} {}\n", lines_crs, grid.crs, grid.west, grid.north,
                                       grid.cell_m, grid.width, grid.height);
        for (NamedFile const& file : files) {
            text += fmt::format("{} {} {}\n", file.key->place(file.item), file.name, file.layer);
        }
        return text + state_of_files(recipe);
    };
    auto const look = [&] {
        std::vector<Finding> notes;
        for (NamedFile const& file : files) {
            bool const is_lines = file.key->help.path == "network.lines.path";
            for (std::string const& words : io::conversions_of(file_in(recipe, file.name), file.layer, grid.crs,
                                                               is_lines ? lines_crs : std::string())) {
                notes.push_back({.kind = "converted", .text = words, .key = file.key->place(file.item)});
            }
        }
        append(notes, stretch_of(grid));
        return notes;
    };
    constexpr std::int64_t of_note = 256;
    return cached(run, "conversions", made_from, look,
                  [](auto const& notes) { return of_note * static_cast<std::int64_t>(notes.size()); });
}

std::vector<std::string> file_names(Recipe const& recipe) {
    std::vector<std::string> names;
    for (NamedFile const& file : files_of(recipe)) {
        names.push_back(file.name);
    }
    return names;
}

std::string state_of_files(Recipe const& recipe) {
    std::string state;
    for (std::string const& name : file_names(recipe)) {
        state += is_address(name) ? name : state_of(fs::absolute(file_in(recipe, name).path));
    }
    return state + recipe.folder;
}

Recipe keep_inputs(Recipe recipe, io::OutputFolder const& out) {
    for (NamedFile const& file : files_of(recipe)) {
        Key const& key = *file.key;
        bool const is_array = key.part->is_array;
        if (is_array || key.use(recipe)) {
            std::string const items = is_array ? fmt::format("{}{}/", key.part->name, file.item + 1) : "";
            std::string const into = "inputs/" + items + key.folder;
            key.put(recipe, keep_input(out, recipe.folder, file.name, into), file.item);
        }
    }
    recipe.folder.clear();
    return recipe;
}

std::string keep_user_file(std::string const& path, io::OutputFolder const& out, Run const& run) {
    std::error_code ignored;
    refuse_if<BadInput>(path.empty() || (!is_address(path) && !fs::exists(path, ignored)), "recipe.keep_user_file",
                        "there is no file {}", path);
    return is_plain(path) ? keep_input(out, "", path, "")
                          : fs::path(io::plain_copy(path, "", out.staging(), run)).filename().string();
}

UserFiles::UserFiles(Recipe& recipe, Run const& run) {
    for (NamedFile const& file : files_of(recipe)) {
        std::string const place = file.key->place(file.item);
        if (is_users(recipe, place)) {
            auto const work = [&] { return copied(recipe, file.name, file.layer, run); };
            bool const is_set = recipe.set_at.contains(place); // else it is named on the command line
            std::string const copy =
                is_set ? naming_key(fmt::format("[{}] {}", file.key->section(), file.key->name()), work) : work();
            if (copy != file.name && !io::names_connection(file.name)) { // whose name may contain a password
                recipe.copy_of[copy] = file.name;
            }
            file.key->put(recipe, copy, file.item);
        }
    }
}

std::string UserFiles::copied(Recipe const& recipe, std::string const& name, std::string const& layer, Run const& run) {
    std::string const path = file_in(recipe, name).path;
    std::error_code ignored;
    bool const is_missing = !io::names_connection(path) && !fs::exists(path, ignored) && !path.starts_with("/vsi") &&
                            io::file_of_part(path).empty();
    if (name.empty() || is_missing || is_plain(path)) {
        return name; // what is missing is reported by the stage that needs it
    }
    if (!folder_) {
        folder_ = std::make_unique<io::TemporaryFolder>("thalweg-inputs");
    }
    fs::path const own = folder_->path() / fmt::format("{}", ++copies_);
    fs::create_directory(own);
    return io::plain_copy(path, layer, own.string(), run);
}

} // namespace thalweg::recipe
