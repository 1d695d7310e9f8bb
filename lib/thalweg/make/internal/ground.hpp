// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include <thalweg/core/features.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/make/ground.hpp>
#include <thalweg/make/internal/raise_rivers.hpp>
#include <thalweg/make/planform.hpp>
#include <thalweg/make/terrain.hpp>
#include <thalweg/recipe/plan.hpp>
#include <thalweg/recipe/recipe.hpp>

namespace thalweg::make {

/// What a surface is made from: what a plan has for it, and its rivers. It refers to values for the time of a call.
struct SurfaceInput {
    recipe::Recipe recipe;    ///< with the keys that it reads: recipe_for_surface()
    Planform const& planform; ///< without arcs where there are no rivers
    FeaturePoints const& points;
    RiverLines const& ridges;    ///< given ones
    Raster<float> const& raster; ///< of surface.source, on the recipe's grid; without cells: none
    std::optional<recipe::LikeDem> const& like;
    Mask const& gaps; ///< 0: a gap of the DEM that rebuilt terrain is compared with; without cells: there is none
    bool has_coastlines = false; ///< those of the rivers' file bound the land
};

/// What a terrain is made from.
struct TerrainInput {
    recipe::Recipe const& recipe;
    std::optional<Grid> const& grid; ///< empty: that of the rivers
    SurfaceInput surface;
};

/// Draws the terrain of a recipe. make_terrain() of a plan's values.
Terrain draw_terrain(TerrainInput const& in, Run const& run);

/// The same on its grid, with the rivers' heights.
struct GroundInput : SurfaceInput {
    Grid const& grid;           ///< of the surface; without rivers of coarser cells, where detail is added between them
    Grid const& fine;           ///< of the terrain
    RaisedRivers const& rivers; ///< without arcs where their heights follow from the surface
};

/// A surface, the rivers with their heights in it, and what was found and checked.
struct Surface {
    Ground ground = {};
    Rivers rivers = {};
    RiverBed bed = {};
    Notes notes = {};
};

// The grounds: each makes a surface in its own way, and reads nothing that the recipe sets for other ways.

/// In equilibrium of uplift and erosion with rivers, which get their heights from the surface.
Surface equilibrium(GroundInput const& in, Run const& run);

/// The same with rivers whose heights their file has.
Surface rebuild(GroundInput const& in, Run const& run);

/// By dilation of the cells of rivers, which keep their heights, as with all that follow.
Surface dilate(GroundInput const& in, Run const& run);

/// By diffusion from rivers, ridges and points.
Surface diffuse(GroundInput const& in, Run const& run);

/// Over triangles of rivers, ridges and points.
Surface tin(GroundInput const& in, Run const& run);

/// The DEM of surface.source, with the cells of rivers where there are any.
Surface raster(GroundInput const& in, Run const& run);

/// Without rivers: a random surface with the statistics that are asked for.
Surface statistics(GroundInput const& in, Run const& run);

/// Without rivers: a surface through points.
Surface points(GroundInput const& in, Run const& run);

/// The ground that a recipe asks for.
using MakeGround = Surface (*)(GroundInput const& in, Run const& run);
MakeGround ground_of(recipe::Recipe const& recipe);

// Detail.

/// Throws, before any work, when the statistics of a recipe cannot be reached on a grid.
/// \return warnings of lengths that only a fit can determine
std::vector<Finding> require_targets(recipe::Recipe const& recipe, Grid const& grid);

/// A surface with fractal detail, where the recipe asks for it: around rivers none in the valleys, all of it some
/// cells away; without rivers between the cells of the coarse surface. Without rivers it is then matched to the
/// statistics that are asked for, or loses heights where surface.source and surface.mask have none.
/// \param in of which the surface was made
Surface refined(Surface surface, GroundInput const& in, Run const& run);

} // namespace thalweg::make
