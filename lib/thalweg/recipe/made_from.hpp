// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \internal For the modules above this one.

#include <string>

#include <thalweg/recipe/recipe.hpp>

namespace thalweg::recipe {

// What decides the result of a stage, as a text for kept_or_made(): the recipe without the keys that only later stages
// read, and the state of the files it names. heights_of_file: as Plan

/// Of lines as their file has them.
std::string lines_made_from(Recipe const& recipe);

/// Of the DEM that is the surface, and its grid.
std::string raster_made_from(Recipe const& recipe);

/// Of a cluster, before a branch of it is chosen.
std::string cluster_made_from(Recipe const& recipe);

/// Of rivers as their source gives them, before they are pruned.
std::string source_made_from(Recipe const& recipe, bool heights_of_file);

/// Of rivers in plan view.
std::string planform_made_from(Recipe const& recipe, bool heights_of_file);

/// Of the surface before patches and drainage.
std::string surface_made_from(Recipe const& recipe, bool heights_of_file);

} // namespace thalweg::recipe
