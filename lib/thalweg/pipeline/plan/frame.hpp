// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/features.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/network/growth/dla/grow_dla.hpp>
#include <thalweg/pipeline/recipe/recipe.hpp>

namespace thalweg::pipeline {

/// 45 degrees north on the central meridian of UTM zone 31, which stands for no real place.
inline constexpr double default_west = 500000.0;
inline constexpr double default_north = 5000000.0;

/// \param side_cells [cells] cells along the longer side
/// \return the largest box [cells] a network may have in a side of a grid of this many cells, 5 % left free around it.
std::int64_t room_for_network(std::int64_t side_cells);

/// \param side_cells [cells] cells along the longer side
/// \return what is left free [cells] on each side of a network whose longer side has this many cells.
std::int64_t margin_around(std::int64_t side_cells);

/// A branch on its grid.
struct FramedBranch {
    Mask mask;  ///< its cells
    Vec2 mouth; ///< [m] centre of the cluster's seed; may lie outside the grid
};

/// Puts a branch into the middle of the grid asked for, or of a grid 5 % larger than its box. The frame follows from
/// the branch alone: pruning does not move it.
/// \param wanted the grid of the recipe; 0: chosen
/// \return the branch on its grid
FramedBranch frame_branch(network::Branch const& branch, GridRecipe const& wanted);

/// \param wanted the grid of the recipe; 0: chosen
/// \return the grid asked for, or the lines' box and 5 % around it on multiples of the cell.
/// \throws BadInput naming the first line outside an asked grid, unless clip is set; like require_no_stray_vertex where
/// no size is set
Grid frame_lines(RiverLines const& lines, GridRecipe const& wanted);

/// \param links number of links
/// \param wanted the grid of the recipe; 0: chosen
/// \return the grid asked for, or a square one in which so many links of a tree lie some twelve cells apart.
Grid frame_tree(std::int64_t links, GridRecipe const& wanted);

/// \param wanted the grid of the recipe; 0: chosen
/// \return the grid asked for, or the polygons' box and 5 % around it on multiples of the cell.
/// \throws BadInput naming the first polygon that leaves an asked grid, unless clip is set
Grid frame_polygons(Polygons const& polygons, GridRecipe const& wanted);

/// \param cells the cells
/// \return memory [bytes] that a terrain of this many cells takes while it is made, at most.
std::int64_t bytes_needed(std::int64_t cells);

/// \param width [cells] number of columns
/// \param height [cells] number of rows
/// \throws BadInput when a terrain on this grid needs more memory than is free
void check_memory(std::int64_t width, std::int64_t height);

/// \throws BadInput when a cluster of this many particles needs more memory than is free
void check_memory_of_cluster(std::int64_t particles);

} // namespace thalweg::pipeline
