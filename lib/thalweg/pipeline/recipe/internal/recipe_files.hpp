// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_keys.hpp>
#include <thalweg/pipeline/recipe/recipe.hpp>

/// What a recipe names. Private to this module.
namespace thalweg::pipeline {

/// A file the recipe names, found from the recipe's folder.
std::string file_in(Recipe const& recipe, std::string const& name);

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

/// The recipe of a terrain on this grid.
Recipe framed(Recipe recipe, Grid const& grid);

} // namespace thalweg::pipeline
