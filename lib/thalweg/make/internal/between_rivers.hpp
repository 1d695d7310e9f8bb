// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/features.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/run/stage_log.hpp>
#include <thalweg/core/tin.hpp>
#include <thalweg/make/internal/ground.hpp>
#include <thalweg/make/valley_cells.hpp>
#include <thalweg/recipe/recipe.hpp>
#include <thalweg/skeleton/scatter.hpp>

namespace thalweg::make {

/// What a surface between rivers is drawn through.
struct Between {
    Rivers rivers;
    ValleyCells valley;
    RidgeLines ridges = {};     ///< midway between streams
    RidgeLines given = {};      ///< with heights at all vertices
    Tin tin = {};               ///< without vertices where none is asked for
    FeaturePoints points = {};  ///< given or random, with those of given ridges
    FeaturePoints through = {}; ///< of these, those that are not random
    Mask inside = {};           ///< cells that get heights
    bool is_whole = false;      ///< all of them
    std::vector<Check> checks = {};
};

/// Rivers as they were raised, ridges between them, random points and a TIN, as the recipe asks for them.
/// stage_log: gets what was found on the rivers, too.
Between between_rivers(GroundInput const& in, StageLog& stage_log, Run const& run);

/// The surface that was drawn. Its checks follow those of the points.
Surface surface_between(GroundInput const& in, Between between, Raster<float> dem, HowMade how,
                        std::vector<Check> const& checks, StageLog& stage_log);

/// Ridges between the streams, where the recipe asks for them.
RidgeLines ridges_between(GroundInput const& in, Rivers const& rivers, StageLog& stage_log, Run const& run);

/// The triangles of points, rivers and ridges, whose lines are breaklines, where the recipe needs them.
Tin triangulated(recipe::Recipe const& recipe, ElevatedNetwork const& network, RidgeLines const& ridges,
                 FeaturePoints const& points, StageLog& stage_log, Run const& run);

/// The lines of both.
RidgeLines joined(RidgeLines some, RidgeLines const& others);

/// A surface with the heights of valley cells.
Raster<float> with_valley(Raster<float> dem, ValleyCells const& valley);

/// A surface over the triangles between rivers. Valley cells keep their heights.
Raster<float> over_triangles(Between const& between, Run const& run);

/// A surface with heights in the cells of a mask only.
Raster<float> only_inside(Raster<float> dem, Mask const& inside);

/// The check points_missing: random points that found no room, with findings on room.
Check points_missing(skeleton::ScatteredPoints const& points, recipe::SkeletonRecipe const& wanted,
                     StageLog& stage_log);

} // namespace thalweg::make
