// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/features.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/pipeline/recipe/recipe.hpp>

/// The points of [skeleton]. Private to this module.
namespace thalweg::pipeline {

/// The points of [skeleton]: of a file, or none. Their CRS is that of the grid, also where there are none.
FeaturePoints given_points(Recipe const& recipe, Run const& run);

/// The grid asked for, or the points' box and 5 % around it on multiples of the cell.
Grid frame_land(FeaturePoints const& points, GridRecipe const& wanted);

/// Throws BadInput naming the first point off the grid. name: the file, as the recipe has it.
void require_on_grid(FeaturePoints const& points, Grid const& grid, std::string const& name);

} // namespace thalweg::pipeline
