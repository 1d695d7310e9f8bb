// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/pipeline/plan/plan.hpp>
#include <thalweg/pipeline/recipe/recipe.hpp>

namespace thalweg::pipeline {

/// What make() would do with a recipe.
struct Forecast {
    std::vector<std::string> stages; ///< in order, with the names of its timings
    std::optional<Grid> grid;        ///< empty: it follows from rivers that have to be grown first
    std::int64_t cells = 0;          ///< of the grid, an estimate where it is unknown
    std::int64_t memory_bytes = 0;   ///< at most, estimated
    double seconds = 0.0;            ///< estimated, on one core of 2020
};

/// \param plan the plan
/// \return the stages that make() times, in its order, and estimates.
Forecast forecast(Plan const& plan);

/// Plans a recipe and says what a run would do, without running it.
/// \param recipe the recipe
/// \param run progress, log of warnings, stop token and number of threads
/// \return the forecast of its plan
/// \throws Error as resolve()
Forecast forecast(Recipe const& recipe, Run const& run = {});

} // namespace thalweg::pipeline
