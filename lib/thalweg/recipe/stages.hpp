// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \internal For the modules above this one.

#include <string>
#include <vector>

#include <thalweg/core/append.hpp>
#include <thalweg/core/features.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/run/stage_log.hpp>
#include <thalweg/growth/tokunaga/grow_tokunaga.hpp>
#include <thalweg/recipe/plan.hpp>
#include <thalweg/recipe/recipe.hpp>

namespace thalweg::recipe {

// Predicates for the stages of a plan, common to make, which runs them, and the forecast, which lists them.

/// Whether coastlines of the rivers' file bound the land.
bool has_coastlines(NetworkRecipe const& rivers, RiverLines const& lines);

/// Whether rivers go through the meander stage.
bool has_meanders(Recipe const& recipe);

/// Whether rivers take their heights from the terrain.
bool heights_follow_terrain(Recipe const& recipe);

/// Whether rivers take their heights from a DEM that is the terrain.
bool heights_follow_raster(Recipe const& recipe);

/// Whether random points lie between the rivers, or in the terrain.
bool scatters_points(Recipe const& recipe);

/// Whether ridges are drawn between the rivers.
bool has_ridges(Recipe const& recipe);

/// Whether rivers, ridges and points are triangulated.
bool needs_tin(Recipe const& recipe);

/// Whether the terrain is conditioned hydrologically.
bool conditions_dem(Recipe const& recipe);

/// Whether the catchments of the arcs are found.
bool finds_catchments(Recipe const& recipe);

/// Whether contributing areas are measured by cell.
bool measures_areas(Recipe const& recipe);

/// Whether the terrain's own side valleys become arcs.
bool adds_side_valleys(Recipe const& recipe);

// Networks that branch by Tokunaga's law.

/// Advice if links find no room.
inline constexpr char const* more_room =
    "lower network.tokunaga.order or spacing, or take a larger grid (or smaller cells)";

/// The tree that a recipe grows by Tokunaga's law.
growth::TokunagaParams tree_of(Recipe const& recipe);

/// Rejects lines of which one vertex, or at most 1 %, is more than twenty times as far away as all others: a corrupt
/// coordinate that would enlarge the grid. Fewer than 20 vertices are not judged.
/// \throws BadInput naming the line, the vertex and the remedy
void require_no_stray_vertex(RiverLines const& lines);

/// The requested grid, or the points' box and 5 % around it on multiples of the cell.
Grid frame_land(FeaturePoints const& points, GridRecipe const& wanted);

/// Throws BadInput naming the first point off the grid. name: the file, as in the recipe.
void require_on_grid(FeaturePoints const& points, Grid const& grid, std::string const& name);
/// The same for the points and ridges of a recipe's files.
void require_skeleton_on_grid(Recipe const& recipe, FeaturePoints const& points, RiverLines const& ridges,
                              Grid const& grid);

} // namespace thalweg::recipe
