// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \internal For the modules above this one.

#include <cstdint>
#include <optional>
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
#include <thalweg/recipe/condition.hpp>
#include <thalweg/recipe/recipe.hpp>

namespace thalweg::recipe {

/// A condition on the rivers' file.
struct LinesCondition {
    bool (*holds)(RiverLines const& lines) = nullptr; ///< null: for any file
    char const* words = "";                           ///< the file "has coastlines"
};

/// A step of make. This is the one place that says when it runs and what it costs: make asks it, and forecasts,
/// progress, timings and `thalweg recipe --json` have its name.
struct Stage {
    char const* name;
    double seconds_a_million; ///< of cells, on one core of 2020; estimated
    Condition when;           ///< on a recipe with its defaults
    LinesCondition lines = {};

    /// \param recipe with its defaults
    /// \param of_file lines of the rivers' file
    bool runs(Recipe const& recipe, RiverLines const& of_file = {}) const {
        return when(recipe) && (lines.holds == nullptr || lines.holds(of_file));
    }
    /// In words.
    std::string runs_if() const;
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

/// The stages that run, in order; blend once for each patch.
/// \param recipe with its defaults
/// \param lines of the rivers' file
std::vector<Stage const*> stages_of(Recipe const& recipe, RiverLines const& lines);

/// The cells of a grid, or an estimate where it depends on a cluster that must be grown first.
std::int64_t cells_of(Recipe const& recipe, std::optional<Grid> const& grid);

/// What the stages that run are expected to take on one core of 2020, and last their files: "write".
/// \param recipe with its defaults
/// \param lines of the rivers' file
Timings expected_times(Recipe const& recipe, RiverLines const& lines, std::int64_t cells);

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
