// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/height_unit.hpp>
#include <thalweg/io/network/schema.hpp>
#include <thalweg/pipeline/recipe/sections/network.hpp>
#include <thalweg/pipeline/recipe/sections/terrain.hpp>

namespace thalweg::pipeline {

/// Where the land lies. What is left out is chosen from the network.
struct GridRecipe {
    std::int64_t width = 0;  ///< [cells] 0: the network's box and 5 % around it
    std::int64_t height = 0; ///< [cells] likewise
    double cell_m = 30.0;    ///< [m] > 0; 0 chooses it from the lines of a file
    std::string crs;         ///< projected, metres; "": the line file's own or its UTM zone, else EPSG:32631
    std::optional<std::array<double, 2>> origin; ///< [m] west and north edge
    bool clip = false;                           ///< cut rivers at the grid's edge instead of refusing them
};

/// The keys of section [output] of a recipe.
struct OutputRecipe {
    std::string title;                      ///< of the pictures and the page; "" names the seed
    double contour_interval = 0.0;          ///< [units] 0 chooses a round number
    bool catchments = true;                 ///< of the arcs, where there are rivers and a surface
    bool accumulation = false;              ///< contributing areas by cell, where there is a surface
    io::Schema schema = io::Schema::native; ///< another one: a network file more, in its words
    HeightUnit units = HeightUnit::metre;   ///< of heights in dem.tif, networks, contours and TINs
};

/// Everything that decides a result, as one plain value.
struct Recipe {
    std::uint64_t seed = 7;
    GridRecipe grid;
    std::optional<NetworkRecipe> network;
    std::optional<SkeletonRecipe> skeleton;
    std::optional<SurfaceRecipe> surface;
    std::optional<StatisticsRecipe> statistics;
    std::optional<DetailRecipe> detail;
    std::vector<PatchRecipe> patches; ///< in their order
    OutputRecipe output;
    std::string folder;                             ///< file names are relative to it; "" is the working folder
    std::map<std::string, std::string> set_at = {}; ///< where keys were set, for messages: "r.toml, line 3" or "--set"
};

/// \return what `thalweg make` makes without a recipe; the same as samples/relief.toml.
Recipe default_recipe();

/// \param width,height [cells] of the grid
/// \return the same on another grid: on small ones rivers lie closer.
Recipe default_recipe_on(std::int64_t width, std::int64_t height);

/// \return what it makes where keys of a cluster are set; the same as samples/relief_dla.toml.
Recipe cluster_recipe();

/// What a key of a recipe file means.
struct KeyHelp {
    std::string path;     ///< section.key
    std::string type;     ///< integer | number | text | yes/no | two numbers
    std::string range;    ///< in words or the choices
    std::string unit;     ///< "" for none
    std::string standard; ///< default as TOML, or in words
    std::string meaning;
    std::vector<std::string> choices = {}; ///< words it may be; of an expression, those with a name; {} for none
    std::string used_by = {};              ///< what a recipe must hold for the key to have an effect; "": any recipe
    bool is_file = false;                  ///< its value names a file, relative to the recipe's folder
};

/// \return every key in the order of recipe files.
std::vector<KeyHelp> recipe_keys();

/// Reads a recipe from TOML text.
/// \param toml the text of a recipe
/// \param name its name
/// \return the recipe
/// \throws BadParameter with all faults at once: unknown sections and keys (did you mean), wrong types, values out of
/// range. name: for messages
Recipe read_recipe(std::string const& toml, std::string const& name);

/// Sets one key from "section.key=value"; "patch.2.key=value" of the second patch, or a new one after the last. A file
/// is found from the working folder, wherever the recipe lies.
/// \param assignment "section.key=value"
void set_key(Recipe& recipe, std::string const& assignment);

/// \return the recipe as TOML: every key that has an effect, defaults too. read_recipe gives it back.
std::string write_recipe(Recipe const& recipe);

/// \return the title of what a recipe makes: output.title, or "thalweg, seed 7" where that is "".
std::string title_of(Recipe const& recipe);

/// \throws BadParameter naming all that does not fit together (a source without its file, ...), and every key that is
/// set away from its default and has no effect
void check_recipe(Recipe const& recipe);

} // namespace thalweg::pipeline
