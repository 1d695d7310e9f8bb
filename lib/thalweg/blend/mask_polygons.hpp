// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/polygons.hpp>
#include <thalweg/core/raster.hpp>

namespace thalweg::blend {

/// By cell the polygon in which its centre lies, counted from 1; of several the last; 0 for none.
/// \pre polygons in the grid's coordinates; they may overlap, leave the grid and cross themselves (even-odd).
/// \param polygons the polygons
/// \param grid the grid
/// \return of two polygons that share an edge each centre on it to exactly one; nothing for a polygon between centres.
/// \throws BadInput naming polygon and feature when a ring has fewer than three vertices or one that is not finite, and
/// when no cell's centre lies in any: it names both places
Raster<std::int32_t> number_polygons(Polygons const& polygons, Grid const& grid);

/// \param polygons the polygons
/// \param grid the grid
/// \return the cells to which number_polygons gives a polygon.
/// \throws Error likewise
Mask mask_polygons(Polygons const& polygons, Grid const& grid);

} // namespace thalweg::blend
