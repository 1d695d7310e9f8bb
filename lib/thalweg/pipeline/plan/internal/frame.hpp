// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/features.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/pipeline/recipe/recipe.hpp>

namespace thalweg::pipeline {

/// Refuses to take a grid from lines of which one vertex, or at most 1 %, lies more than twenty times as far away as
/// all others reach: a coordinate that was lost. Fewer than 20 vertices tell nothing. Throws: BadInput naming the line,
/// the vertex and what to do.
void require_no_stray_vertex(RiverLines const& lines);

/// The grid asked for, or the points' box and 5 % around it on multiples of the cell.
Grid frame_land(FeaturePoints const& points, GridRecipe const& wanted);

/// Throws BadInput naming the first point off the grid. name: the file, as the recipe has it.
void require_on_grid(FeaturePoints const& points, Grid const& grid, std::string const& name);

} // namespace thalweg::pipeline
