// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \internal For the modules above this one.

#include <span>
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

/// A step of make. This is the one place that says when it runs and what it costs: make asks it, and forecasts,
/// progress and timings have its name.
struct Stage {
    char const* name;
    double seconds_a_million; ///< of cells, on one core of 2020; estimated
    /// lines: of the rivers' file
    bool (*runs_with)(Recipe const& recipe, RiverLines const& lines);

    /// \param recipe with its defaults
    /// \param lines of the rivers' file, which tell whether there are coastlines
    bool runs(Recipe const& recipe, RiverLines const& lines = {}) const { return runs_with(recipe, lines); }
};

/// The stages. timings_s of report.json has these names.
namespace stage {
extern Stage const raster, read, shape, grow, thin, trace, embed, adopt, sea, prune, meander, raise;
extern Stage const channels, fill_in_equilibrium, scatter, ridge, tin, fill_dilated, fill, land, detail, project;
extern Stage const blend; ///< once for each patch
extern Stage const carve, drain, valleys, measure, catchments, certify, ridges, areas, laws, relief, check, compare;
} // namespace stage

/// All of them, in the order in which they run.
std::span<Stage const* const> all_stages();

/// The stages that run for a plan, in order; blend once for each patch.
std::vector<Stage const*> stages_of(Plan const& plan);

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
