// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/feature_points.hpp>
#include <thalweg/pipeline/diary.hpp>
#include <thalweg/pipeline/terrain.hpp>

/// Land from numbers and from points (paper 001), and over the triangles of rivers. Private to this room.
namespace thalweg::pipeline {

/// The points of [skeleton]: of a file, or none. Names the grid's CRS where the recipe leaves it out.
FeaturePoints given_points(Recipe& recipe, Run const& run);

/// The grid asked for, or the points' box and 5 % around it on multiples of the cell.
Grid frame_land(FeaturePoints const& points, GridRecipe const& wanted);

/// Land without rivers: a random one or that of points, with fractal detail, brought to the statistics.
/// Fills in what of the terrain tells about it: surface, tin, projection, checks.
void make_land(Terrain& terrain, FeaturePoints const& points, Diary& diary, Run const& run);

/// The triangles of points and rivers, whose arcs are breaklines.
void make_skeleton_tin(Terrain& terrain, FeaturePoints const& points, Diary& diary, Run const& run);

/// Land over the skeleton's triangles: as it is, or as the base that slopes rise from. Valley cells keep their heights.
surface::Dilated draw_over_tin(Terrain const& terrain, Run const& run);

/// Adds fractal detail to land with rivers: none in the valleys, all of it some cells away.
void add_detail(Terrain const& terrain, Raster<float>& dem, Run const& run);

} // namespace thalweg::pipeline
