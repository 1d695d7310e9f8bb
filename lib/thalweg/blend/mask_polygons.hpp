// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/features.hpp>
#include <thalweg/core/raster.hpp>

// Idea: A cell belongs to a polygon if a ray from its centre crosses the outline an odd number of
// times. Row by row the crossings of all edges with the row of centres are sorted, and cells
// between the first and second, third and fourth, ... lie inside. A crossing is counted by one rule
// for both polygons at a common edge, so that a centre belongs to exactly one.
// Source: the even-odd rule of scan conversion.
// Cost: linear in the rows that each edge crosses and the cells drawn, besides sorting in rows, and
// O(rows) a polygon. One thread.
// Not for: the share of a cell that is covered: only centres count, so that polygons thinner than a
// cell may have none.
// Example:
//     Mask const inside = mask_polygons(polygons, grid);

namespace thalweg::blend {

/// Assigns cells to the polygon that contains their centre (even-odd rule); polygons may overlap and leave the grid.
/// \param polygons in the grid's coordinates
/// \param grid of the result
/// \return by cell: number of the polygon from 1, of several the last; 0: none. A centre on a common edge of two
/// polygons belongs to exactly one.
/// \throws BadInput naming polygon and feature when a ring has fewer than three vertices or one that is not finite;
/// naming both extents when no centre lies in a polygon
Raster<std::int32_t> number_polygons(Polygons const& polygons, Grid const& grid);

/// Marks the cells whose centre lies in a polygon.
/// \param polygons in the grid's coordinates
/// \param grid of the result
/// \return 1: in a polygon
/// \throws BadInput as number_polygons
Mask mask_polygons(Polygons const& polygons, Grid const& grid);

} // namespace thalweg::blend
