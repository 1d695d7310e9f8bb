// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/pipeline/recipe/recipe.hpp>

/// Private to this module.
namespace thalweg::pipeline {

/// Says what the files of a recipe are converted from, and how far the grid leaves its UTM zone.
/// Gives: a note for each: "converted", "stretched".
std::vector<Finding> report_conversions(Recipe const& recipe, Grid const& grid, Run const& run);

} // namespace thalweg::pipeline
