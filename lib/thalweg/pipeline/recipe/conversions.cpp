// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/conversions.hpp>

#include <thalweg/io/frame/places_on_earth.hpp>
#include <thalweg/io/gdal/conversions.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_files.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_keys.hpp>

#include <fmt/format.h>

#include <string>
#include <variant>

namespace thalweg::pipeline {

namespace {

void report_file(Terrain& terrain, std::string const& name, std::string const& layer, Run const& run) {
    if (name.empty()) {
        return;
    }
    for (std::string const& words : io::conversions_of(file_in(terrain.recipe, name), layer, terrain.grid.crs)) {
        run.say(fmt::format("{:<6} {}", "units", words));
        terrain.story.repairs.push_back({"converted", 0, {}, 0.0, words});
    }
}

/// Far from its central meridian a UTM zone measures other lengths than the ground has.
void warn_of_stretch(Terrain& terrain, Run const& run) {
    constexpr double much = 0.01;
    constexpr double percent = 100.0;
    double const stretch = io::zone_stretch(terrain.grid);
    if (!(stretch > much)) {
        return;
    }
    std::string const words =
        fmt::format("the grid reaches far beyond its UTM zone {}: lengths are up to {:.1f} % too long there. Name "
                    "another CRS: --crs EPSG:n",
                    terrain.grid.crs, percent * stretch);
    run.say("warning: " + words);
    terrain.story.repairs.push_back({"stretched", 0, {}, stretch, words});
}

} // namespace

void report_conversions(Terrain& terrain, Run const& run) {
    Recipe const& recipe = terrain.recipe;
    for (Key const& key : all_keys()) {
        auto const value = names_file(key) && key.section() != "patch" ? key.take(recipe) : std::nullopt;
        if (value) {
            bool const of_rivers = key.help.path == "network.lines.path";
            report_file(terrain, std::get<std::string>(*value), of_rivers ? recipe.network->lines.layer : "", run);
        }
    }
    for (PatchRecipe const& patch : recipe.patches) {
        report_file(terrain, patch.source, "", run);
        report_file(terrain, patch.mask, "", run);
    }
    warn_of_stretch(terrain, run);
}

} // namespace thalweg::pipeline
