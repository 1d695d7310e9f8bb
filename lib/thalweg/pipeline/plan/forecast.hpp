// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/grid.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/pipeline/recipe/recipe.hpp>

namespace thalweg::pipeline {

/// What make_terrain() would do with a recipe.
struct Forecast {
    std::vector<std::string> stages; ///< in order, with the names of Terrain::timings_s
    std::optional<Grid> grid;        ///< empty: it follows from rivers that have to be grown first
    std::int64_t cells = 0;          ///< of the grid, an estimate where it is unknown
    std::int64_t memory_bytes = 0;   ///< at most, estimated
    double seconds = 0.0;            ///< estimated, on one core of 2020
};

/// Checks a recipe and its input files, and finds out what a run would do, without running it. Lines, polygons and
/// points are read, since the grid follows from them; rasters are not.
/// \param recipe the recipe
/// \param run progress, log, stop token and number of threads
/// \return the stages that make_terrain() times, in its order.
/// \throws Error like make_terrain() for a wrong recipe or input
/// \throws BadInput where a grid needs more memory than is free
Forecast forecast(Recipe const& recipe, Run const& run = {});

} // namespace thalweg::pipeline
