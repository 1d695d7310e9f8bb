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
#include <thalweg/network/growth/tokunaga/grow_tokunaga.hpp>
#include <thalweg/pipeline/recipe/recipe.hpp>

namespace thalweg::pipeline {

/// What stages took [s], in their order.
using Timings = std::vector<std::pair<std::string, double>>;

/// Where a forest may grow.
struct ForestLand {
    Mask land;                  ///< 0: sea
    bool has_sea = false;       ///< some cell is
    std::vector<Cell> outlets;  ///< on its coast
    std::vector<Finding> notes; ///< outlets that were moved to it
};

/// What a recipe comes to once its files are read: all that can be known before a river is drawn. Nothing of it is
/// rewritten later: what follows from rivers and surface is a result of theirs.
struct Plan {
    Recipe recipe;                ///< with its defaults: CRS, cell, heights, prune, meander, rotate, mean slope, drain
    std::optional<Grid> grid;     ///< empty: it follows from rivers that have to be grown first
    RiverLines lines;             ///< of network.lines.path, inside the grid; or strokes
    Raster<float> line_dem;       ///< of network.lines.dem, in the CRS of the lines; without cells for none
    bool heights_of_file = false; ///< rivers have these because the lines do, not because they were asked for
    std::optional<Polygons> region;            ///< that a Tokunaga tree fills
    std::optional<network::TokunagaTree> tree; ///< which fills the region or the grid: its size gives the grid's
    std::optional<ForestLand> forest;          ///< where rivers are a forest
    FeaturePoints points;                      ///< of skeleton.points; their CRS is the grid's, also without points
    Timings timings_s;                         ///< of what was read and grown for it
};

/// Checks a recipe and its input files and settles all that follows from them. Rivers, strokes, regions, outlets and
/// points are read here and nowhere else; what lies over the surface (masks, fields, lakes, patches) has to be there,
/// and is read when the surface is drawn.
/// \return the same plan for the same recipe and files, whatever the Run.
/// \throws BadParameter naming what does not fit together, and every key that is set and has no effect
/// \throws BadInput where a file is missing or not what its key needs, or the grid needs more memory than is free
Plan resolve(Recipe const& recipe, Run const& run = {});

/// What make() would do with a recipe.
struct Forecast {
    std::vector<std::string> stages; ///< in order, with the names of its timings
    std::optional<Grid> grid;        ///< empty: it follows from rivers that have to be grown first
    std::int64_t cells = 0;          ///< of the grid, an estimate where it is unknown
    std::int64_t memory_bytes = 0;   ///< at most, estimated
    double seconds = 0.0;            ///< estimated, on one core of 2020
};

/// \return the stages that make() times, in its order, and estimates.
Forecast forecast(Plan const& plan);

/// Plans a recipe and says what a run would do, without running it.
/// \return the forecast of its plan
/// \throws Error as resolve()
Forecast forecast(Recipe const& recipe, Run const& run = {});

} // namespace thalweg::pipeline
