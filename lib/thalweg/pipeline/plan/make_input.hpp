// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/run/run.hpp>
#include <thalweg/pipeline/recipe/recipe.hpp>

namespace thalweg::pipeline {

/// The recipe that a path stands for.
/// \param path a recipe (a name that ends in .toml, or a text that begins like TOML), or rivers as io::find_rivers
/// finds them
/// \return of a recipe what it says; of rivers rivers_recipe().
/// \throws BadParameter with all faults of a recipe
/// \throws BadInput when the path is neither, saying what it is
Recipe recipe_from(std::string const& path);

/// \return the recipe for terrain in equilibrium with the rivers of a file or folder: grid.cell is 0, which chooses it
/// from the rivers.
/// \throws BadInput like io::find_rivers
Recipe rivers_recipe(std::string const& path);

/// Writes into a recipe what make_terrain() would choose from its rivers: CRS and cell size; paths become absolute.
/// \return the recipe
/// \throws Cancelled like make_terrain()
Recipe settled_recipe(Recipe const& recipe, Run const& run = {});

} // namespace thalweg::pipeline
