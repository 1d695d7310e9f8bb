// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \internal For the modules above this one.

#include <string>

#include <thalweg/recipe/recipe.hpp>

namespace thalweg::recipe {

// What the stages whose results are kept read of a recipe. Such a stage is given one of these and never the recipe of
// the plan: keys that it does not read have their defaults in it. Its result is kept by the cache key of the same
// recipe: a stage that comes to read one more key sees its default until that key is let through here, and then the
// cache key holds it. What the plan has read for the stage, such as lines, must follow from these keys too: nothing but
// tests sees to it.

/// For lines as their file has them.
Recipe recipe_for_lines(Recipe const& recipe);

/// For the DEM that is the surface, and its grid.
Recipe recipe_for_raster(Recipe const& recipe);

/// For a cluster, before a branch of it is chosen.
Recipe recipe_for_cluster(Recipe const& recipe);

/// For rivers as their source gives them, before they are pruned.
Recipe recipe_for_source(Recipe const& recipe);

/// For rivers in plan view.
Recipe recipe_for_planform(Recipe const& recipe);

/// For the surface before patches and drainage.
Recipe recipe_for_surface(Recipe const& recipe);

/// A text that differs between recipes of which any key differs, with an effect or without, or any file that they name.
std::string cache_key(Recipe const& recipe);

} // namespace thalweg::recipe
