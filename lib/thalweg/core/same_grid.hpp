// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \cpponly

#include <string_view>

#include <thalweg/core/raster.hpp>

namespace thalweg {

/// Requires two rasters to lie on one grid.
/// \param one,other their grids
/// \param where "flow.extract_streams", the function that asks
/// \param what "the DEM and its drainage", for the message
/// \param remedy "drain this DEM", for the message
/// \throws BadInput naming the first difference: size, cells, place or CRS
void require_same_grid(Grid const& one, Grid const& other, std::string_view where, std::string_view what,
                       std::string_view remedy);

} // namespace thalweg
