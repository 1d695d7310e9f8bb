// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/features.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/growth/dla/grow_dla.hpp>
#include <thalweg/recipe/recipe.hpp>

namespace thalweg::recipe {

/// 45 degrees north on the central meridian of UTM zone 31; not a real place.
inline constexpr double default_west = 500000.0;
inline constexpr double default_north = 5000000.0;

/// \internal
/// Computes the largest box of a network in a grid's side, with 5 % left free around it.
/// \param side_cells [cells] side of the grid
/// \return [cells]
std::int64_t room_for_network(std::int64_t side_cells);

/// \internal
/// Computes the margin around a network.
/// \param side_cells [cells] longer side of the network
/// \return [cells] on each side
std::int64_t margin_around(std::int64_t side_cells);

/// A branch on its grid.
struct FramedBranch {
    Mask mask;  ///< its cells
    Vec2 mouth; ///< [m] centre of the cluster's seed; may lie outside the grid
};

/// \internal
/// Places a branch in the middle of the requested grid, or of a grid 5 % larger than its box. The frame follows from
/// the branch alone: pruning does not move it.
/// \param branch picked from a cluster
/// \param wanted the grid of the recipe; 0: chosen
/// \return the branch on its grid
FramedBranch frame_branch(growth::Branch const& branch, GridRecipe const& wanted);

/// \internal
/// Chooses the grid of lines.
/// \param lines [m]
/// \param wanted the grid of the recipe; 0: chosen
/// \return the requested grid, or the lines' box and 5 % around it on multiples of the cell
/// \throws BadInput naming the first line outside a requested grid, unless clip is set; as require_no_stray_vertex if
/// no size is set
Grid frame_lines(RiverLines const& lines, GridRecipe const& wanted);

/// \internal
/// Chooses the grid of a tree.
/// \param links number of links
/// \param wanted the grid of the recipe; 0: chosen
/// \return the requested grid, or a square one in which links are about twelve cells apart
Grid frame_tree(std::int64_t links, GridRecipe const& wanted);

/// \internal
/// Chooses the grid of polygons.
/// \param polygons [m]
/// \param wanted the grid of the recipe; 0: chosen
/// \return the requested grid, or the polygons' box and 5 % around it on multiples of the cell
/// \throws BadInput naming the first polygon outside a requested grid, unless clip is set
Grid frame_polygons(Polygons const& polygons, GridRecipe const& wanted);

/// \internal
/// Chooses the grid of a land without rivers.
/// \param points that it must hold, if there are any
/// \param wanted the grid of the recipe; 0: chosen
/// \return the requested grid, or the points' box and 5 % around it on multiples of the cell
Grid frame_land(FeaturePoints const& points, GridRecipe const& wanted);

/// \internal
/// Rejects lines of which one vertex, or at most 1 %, is more than twenty times as far away as all others: a corrupt
/// coordinate that would enlarge the grid. Fewer than 20 vertices are not judged.
/// \throws BadInput naming the line, the vertex and the remedy
void require_no_stray_vertex(RiverLines const& lines);

/// \internal
/// Requires that the points and ridges of a recipe's files lie on the grid.
/// \throws BadInput naming the file and its first point or ridge off the grid
void require_skeleton_on_grid(Recipe const& recipe, FeaturePoints const& points, RiverLines const& ridges,
                              Grid const& grid);

/// \internal
/// Checks that the memory which any terrain of this size takes is free: a first check, before its stages are known.
/// \param width [cells] number of columns, at most 1e6
/// \param height [cells] number of rows, at most 1e6
/// \throws BadInput when it is not
void check_memory(std::int64_t width, std::int64_t height);

/// \internal
/// Checks that this much memory is free for a terrain.
/// \param bytes that it is expected to take
/// \param width [cells] number of columns
/// \param height [cells] number of rows
/// \throws BadInput when it is not
void require_free(std::int64_t bytes, std::int64_t width, std::int64_t height);

/// \internal
/// Checks the free memory for a cluster.
/// \param particles number of particles
/// \throws BadInput when the cluster needs more memory than is free
void check_memory_of_cluster(std::int64_t particles);

} // namespace thalweg::recipe
