// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/grid.hpp>

namespace thalweg::io {

/// \pre grids with a CRS.
/// \param a a grid with a CRS
/// \param b a grid with a CRS
/// \param of_a what the first is, for messages
/// \param of_b what the second is, for messages
/// \return whether the boxes of longitudes and latitudes around two grids overlap.
/// \throws BadInput when one has no longitudes and latitudes; names whose
bool overlap_on_earth(Grid const& a, Grid const& b, std::string const& of_a, std::string const& of_b);

/// \pre a grid with a CRS.
/// \param grid the grid
/// \param what what it is, for messages
/// \return the CRS in which a grid's land is measured in metres: its own where that is projected in metres and lengths
/// are not off by more than 1 % there, else the UTM zone of its middle.
/// \throws BadInput when the middle is in no UTM zone
std::string metric_crs(Grid const& grid, std::string const& what);

/// \param grid the grid
/// \return by how much a grid's UTM zone lengthens lines at most: 0.01 is 1 %. 0 for a grid in another CRS or in none.
double zone_stretch(Grid const& grid);

} // namespace thalweg::io
