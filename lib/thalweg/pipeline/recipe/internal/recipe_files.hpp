// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_keys.hpp>
#include <thalweg/pipeline/recipe/recipe.hpp>

namespace thalweg::pipeline {

// What a recipe names.

/// A file the recipe names, found from the recipe's folder.
io::Source file_in(Recipe const& recipe, std::string const& name);

/// A file that a key names.
struct NamedFile {
    Key const* key;
    std::size_t item;  ///< of a section that is an array
    std::string name;  ///< as the recipe says it
    std::string layer; ///< "" for any
};

/// Every file that a recipe names, in the order of recipe files.
std::vector<NamedFile> files_of(Recipe const& recipe);

/// Whether a name means a database or an address of GDAL's, which no folder holds.
bool is_address(std::string const& name);

/// The recipe with every file it names found from anywhere.
Recipe with_absolute_files(Recipe recipe);

/// Says what the files of a recipe are converted from, and how far the grid leaves its UTM zone.
/// \return a note for each: "converted", "stretched".
std::vector<Finding> conversions(Recipe const& recipe, Grid const& grid);

} // namespace thalweg::pipeline
