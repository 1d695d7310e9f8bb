// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/network/adopt.hpp>
#include <thalweg/network/grow_dla.hpp>
#include <thalweg/network/pick_branch.hpp>
#include <thalweg/network/set_heights.hpp>
#include <thalweg/surface/dilate.hpp>

namespace thalweg::pipeline {

/// Where the land lies. What is left out is chosen from the network.
struct GridRecipe {
    std::int64_t width = 0;  ///< [cells] 0: the network's box and 5 % around it
    std::int64_t height = 0; ///< [cells] likewise
    double cell_m = 30.0;    ///< [m] > 0
    std::string crs;         ///< projected, metres; "": the line file's own or its UTM zone, else EPSG:32631
    std::optional<std::array<double, 2>> origin; ///< [m] west and north edge
    bool clip = false;                           ///< cut rivers at the grid's edge instead of refusing them
};

enum class Source : std::uint8_t { dla, lines };
enum class Heights : std::uint8_t { automatic, straight, straight_repaired, along_stream, file };

struct LinesRecipe {
    std::string path;
    std::string layer;
    std::string type_field = "rosgen";
    std::string rank_field;
    double snap_m = 0.0; ///< [m] 0 takes 1e-6 of the box's diagonal
    network::Orientation orientation = network::Orientation::automatic;
};

struct NetworkRecipe {
    Source source = Source::dla;
    std::optional<double> prune_cells; ///< [cells] default 20 for dla, 0 for lines
    Heights heights = Heights::automatic;
    double slope = 0.087; ///< [m/m] > 0
    network::DlaParams dla;
    network::BranchChoice branch = network::BranchChoice::largest;
    LinesRecipe lines;
};

enum class Method : std::uint8_t { dilate };
enum class Base : std::uint8_t { paper };

struct SurfaceRecipe {
    Method method = Method::dilate;
    Base base = Base::paper;
    surface::DilateParams dilate;
    std::string mask; ///< raster on the grid: cells with 0 or no data are left out; "" for none
};

struct OutputRecipe {
    std::string title;               ///< of the pictures and the page; "" names the seed
    double contour_interval_m = 0.0; ///< [m] 0 chooses a round number
};

/// Everything that decides a result, as one plain value.
struct Recipe {
    std::uint64_t seed = 7;
    GridRecipe grid;
    std::optional<NetworkRecipe> network;
    std::optional<SurfaceRecipe> surface;
    OutputRecipe output;
    std::string folder; ///< file names are relative to it; "" is the working folder
};

/// What `thalweg make` makes without a recipe; the same as samples/dla.toml.
Recipe default_recipe();

/// What a key of a recipe file means.
struct KeyHelp {
    std::string path;     ///< section.key
    std::string type;     ///< integer | number | text | yes/no | two numbers
    std::string range;    ///< in words or the choices
    std::string unit;     ///< "" for none
    std::string standard; ///< default as TOML, or in words
    std::string meaning;
    std::vector<std::string> choices = {}; ///< words it may be; of an expression, those with a name; {} for none
};

/// Every key in the order of recipe files.
std::vector<KeyHelp> recipe_keys();

/// Reads a recipe from TOML text. Throws BadParameter with all faults at once: unknown sections and keys (did you
/// mean), wrong types, values out of range. name: for messages.
Recipe read_recipe(std::string const& toml, std::string const& name);

/// Sets one key from "section.key=value". Throws BadParameter.
void set_key(Recipe& recipe, std::string const& assignment);

/// The recipe as TOML, every default written out, sections without a stage left out. read_recipe gives it back.
std::string write_recipe(Recipe const& recipe);

/// The title of what a recipe makes: output.title, or "thalweg, seed 7" where that is "".
std::string title_of(Recipe const& recipe);

/// Throws BadParameter naming all that does not fit together (a source without its file, ...).
void check_recipe(Recipe const& recipe);

} // namespace thalweg::pipeline
