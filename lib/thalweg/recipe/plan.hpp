// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <thalweg/core/features.hpp>
#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/run/stage_log.hpp>
#include <thalweg/growth/tokunaga/grow_tokunaga.hpp>
#include <thalweg/recipe/recipe.hpp>

namespace thalweg::recipe {

/// Where a forest may grow.
struct ForestLand {
    Mask land;                 ///< 0: sea; without cells where there is none
    bool has_sea = false;      ///< some cell is sea
    std::vector<Cell> outlets; ///< on its coast
};

/// What terrain takes from the DEM of surface.like.
struct LikeDem {
    double mean_slope_deg = 0.0;
    double correlation = 0.0; ///< [-1, 1] of unit gradients, lag_m apart; NaN: the DEM is too small
    double lag_m = 0.0;       ///< one of measure::texture_lags_m
};

/// A recipe with defaults resolved and input files loaded: everything known before rivers are drawn. It does not change
/// later: results of rivers and surface are stored with these.
struct Plan {
    Recipe recipe;                ///< with its defaults: CRS, cell, heights, prune, meander, rotate, mean slope, drain
    std::optional<Grid> grid;     ///< empty: it depends on rivers that must be grown first
    RiverLines lines;             ///< of network.lines.path, inside the grid; or strokes
    Raster<float> line_dem;       ///< of network.lines.dem, in the CRS of the lines; without cells: none
    Raster<float> raster;         ///< of surface.source, on the grid; without cells: none
    bool heights_of_file = false; ///< used because the lines have them, not because they are requested
    std::optional<Polygons> region;           ///< that a Tokunaga tree fills
    std::optional<growth::TokunagaTree> tree; ///< fills the region or the grid, whose size it may determine
    std::optional<ForestLand> forest;         ///< if rivers are a forest
    std::optional<LikeDem> like;              ///< where surface.like is set
    Raster<float> against; ///< of output.against, on the grid where that is known, else as its file has it
    /// 0: a gap of that DEM, where terrain is rebuilt from heights of a file; without cells: there is none
    Mask land;
    FeaturePoints points;          ///< of skeleton.points; their CRS is the grid's, also without points
    RiverLines ridge_lines;        ///< of skeleton.ridge_lines; a line has heights at all vertices or NaN at all
    std::vector<Finding> findings; ///< on the recipe and what was read
    Timings timings_s;             ///< of reading and growing
};

/// Checks a recipe and its input files and resolves everything that depends on them. Rivers, strokes, regions, outlets,
/// points and a DEM that is the surface are read here only; other files for the surface (masks, fields, lakes, patches)
/// must exist, and are read when the surface is drawn.
/// \param recipe any
/// \return the same plan for the same recipe and files, with any Run
/// \throws BadParameter naming keys that contradict one another, and every key that is set and has no effect
/// \throws BadInput when a file is missing or unsuitable for its key, or the grid needs more memory than is free
Plan resolve(Recipe const& recipe, Run const& run = {});

/// \internal
/// The tree that a recipe grows by Tokunaga's law.
growth::TokunagaParams tree_of(Recipe const& recipe);

/// \internal
/// Advice if the links of such a tree find no room.
inline constexpr char const* more_room =
    "lower network.tokunaga.order or spacing, or take a larger grid (or smaller cells)";

/// What make() would do with a recipe.
struct Forecast {
    std::vector<std::string> stages; ///< in order, named as in its timings
    std::optional<Grid> grid;        ///< empty: it depends on rivers that must be grown first
    std::int64_t cells = 0;          ///< of the grid; an estimate if it is unknown
    std::int64_t memory_bytes = 0;   ///< at its peak, of the whole program; estimated, within some 15 %
    double seconds = 0.0;            ///< [s] estimated, on one core of 2020
    std::vector<Finding> findings;   ///< of the plan
};

/// Estimates the work of make().
/// \param plan of a recipe
/// \return its stages in order, and estimates
Forecast forecast(Plan const& plan);

/// Plans a recipe and estimates the work of a run, without running it.
/// \param recipe any
/// \return the forecast of its plan
/// \throws Error as resolve()
Forecast forecast(Recipe const& recipe, Run const& run = {});

} // namespace thalweg::recipe
