// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/feature_points.hpp>
#include <thalweg/pipeline/make/drawn_terrain.hpp>
#include <thalweg/pipeline/plan/internal/diary.hpp>

/// Land from numbers and from points (paper 001). Private to this room.
namespace thalweg::pipeline {

/// The points of [skeleton]: of a file, or none. Their CRS is that of the grid, also where there are none.
FeaturePoints given_points(Recipe const& recipe, Run const& run);

/// The grid asked for, or the points' box and 5 % around it on multiples of the cell.
Grid frame_land(FeaturePoints const& points, GridRecipe const& wanted);

/// Throws BadInput naming the first point off the grid. name: the file, as the recipe has it.
void require_on_grid(FeaturePoints const& points, Grid const& grid, std::string const& name);

/// The check points_missing: random points that found no room, with a warning.
Check points_missing(std::int64_t missing, std::int64_t wanted, Run const& run);

/// Land without rivers: a random one or that of points, with fractal detail, brought to the statistics.
DrawnTerrain make_land(Recipe const& recipe, Grid const& grid, FeaturePoints const& points, Diary& diary,
                       Run const& run);

/// Land with fractal detail, and the recipe with H and sigma as used.
struct Detailed {
    Recipe recipe;
    Raster<float> land;
};

/// Relief of this fractal detail alone, on ground that is flat.
Detailed detail_alone(Recipe recipe, Grid const& grid, Run const& run);

} // namespace thalweg::pipeline
