// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

// Idea: Midpoint displacement goes from corners to the cells between; this goes the other way. From
// the finest level up, a parent of the diamond-square scheme without a height takes the mean of its
// known children, so that heights spread from thin lines to lattice points around them, and a later
// interpolation has more to hold on to. Children farther than L do not count: few cells are added
// for L = 1.5.
// Source: Northeast Normal University 2015, section 3.2; Belhadj and Audibert 2005.
// Cost: O(cells) for all levels together, at half steps 1, 2, 4, ... up to L. Rows of a level run
// on all cores.
// Not for: interpolation of a whole surface (surface/diffusion/diffusion.hpp): most cells stay
// empty. New cells follow the lattice of the scheme, not the terrain.
// Example:
//     Skeleton const more = midpoint_inverse(skeleton_heights, {.longest_cells = 3.0});
// More: docs/rivers.md, "Ridges".

namespace thalweg::skeleton {

/// Options of midpoint_inverse().
struct MidpointInverseParams {
    double longest_cells = 1.5; ///< [cells] >= 0, L: largest distance of a cell's children; 0: adds none
};

/// Extends a skeleton by inverse midpoint displacement: from the finest level up, parents without heights in the
/// diamond-square scheme take the mean of known children. The scheme's square of 2^n + 1 cells has the skeleton in its
/// north-west; its other cells may pass heights on.
/// \param skeleton [m] of any size
/// \return the skeleton's cells bit for bit; a new cell is the mean of its known children at one distance d <= L: for
/// half-steps h = 1, 2, 4, ... first edge midpoints (d = h), then centres of squares (d = h sqrt 2). Heights stay
/// within the skeleton's range; more cells for larger L.
/// \throws BadParameter when L is outside its range
/// \throws BadInput naming the cell with an infinite height
///
/// Source: \cite nenu2015, section 3.2; \cite belhadj2005.
Skeleton midpoint_inverse(Skeleton const& skeleton, MidpointInverseParams const& params = {}, Run const& run = {});

} // namespace thalweg::skeleton
