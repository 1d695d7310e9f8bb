// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/polygons.hpp>
#include <thalweg/core/raster.hpp>

namespace thalweg::blend {

/// The cells whose centres lie in any of some polygons.
/// Takes: polygons in the grid's coordinates; they may overlap, leave the grid and cross themselves (even-odd).
/// Gives: of two polygons that share an edge each centre on it to exactly one.
/// Throws: BadInput naming polygon and feature when a ring has fewer than three vertices or one that is not finite, and
/// when no cell's centre lies in any: it names both places.
Mask mask_polygons(Polygons const& polygons, Grid const& grid);

} // namespace thalweg::blend
