// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/grid.hpp>

namespace thalweg::io {

/// \param a a CRS
/// \param b a CRS
/// \param of_a what the first is, for messages
/// \param of_b what the second is, for messages
/// \return whether two CRS ("EPSG:n", WKT, "" for none) have the same horizontal coordinates.
/// \throws BadInput when exactly one of them is "", naming both sides; of_a and of_b name both sides in the message
bool same_crs(std::string const& a, std::string const& b, std::string const& of_a, std::string const& of_b);

/// \param a a grid
/// \param b a grid
/// \return whether the cells of two grids have sides of the same length, to a millionth; their units do not matter.
bool same_size(Grid const& a, Grid const& b);

/// \param a a grid
/// \param b a grid
/// \return whether two grids have cell for cell the same place, to a hundredth of a cell; their CRS do not matter.
bool same_cells(Grid const& a, Grid const& b);

} // namespace thalweg::io
