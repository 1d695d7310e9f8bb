// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \internal For the modules above this one.

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/recipe/condition.hpp>
#include <thalweg/recipe/recipe.hpp>

namespace thalweg::recipe {

// What several keys of a recipe ask for together.

/// Whether a patch may take the place of rivers.
bool replaces_rivers(Recipe const& recipe);

/// How many times detail halves the cells; 0 without it.
int levels_of(Recipe const& recipe);

/// The coarse cells that detail starts from: every 2^levels-th of the grid, as many as cover it.
Grid coarse_grid(Grid const& grid, int levels);

/// Throws BadParameter where the recipe's detail cannot be made on a grid of this size: exact detail is made from few
/// coarse cells, on a lattice whose torus is not too large (where H is estimated, the smallest that may come of it).
void check_detail(Recipe const& recipe, std::int64_t width, std::int64_t height);

// Keys that are set and have no effect.

/// A key that has no effect in a recipe though it is set.
struct UnusedKey {
    std::string path;  ///< "patch.2.rivers" of the second patch
    std::string words; ///< for people: the value, where it is set, and what has to change for it to have an effect
};

/// Keys without an effect whose value is neither their default nor that of an earlier version, in the order of recipe
/// files.
std::vector<UnusedKey> unused_keys(Recipe const& recipe);

/// The same of keys that a file or --set has set, once the recipe has every default resolved.
/// \throws BadParameter that names them
void refuse_unused_keys(Recipe const& resolved);

} // namespace thalweg::recipe
