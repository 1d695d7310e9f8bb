// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include <thalweg/core/grid.hpp>

namespace thalweg::io {

/// What a grid's coordinates count.
enum class GridUnit : std::uint8_t {
    metres,  ///< of a projected CRS
    degrees, ///< of a geographic CRS, in whatever unit of angle
    other,   ///< feet, or metres of a CRS that is not projected
    unknown  ///< there is no CRS
};

/// What ground_cell() returns.
struct GroundCell {
    GridUnit unit = GridUnit::unknown;
    double side_m = 0.0; ///< [m]
    std::string crs;     ///< as projected_crs gives it; "" unless the unit is metres
};

/// How large a grid's cells are on the ground.
/// \param grid any grid with cells above 0
/// \return of a geographic grid the side of the square as large as a cell in the middle row on the CRS's ellipsoid;
/// else the cell's own side, in metres where the CRS tells them.
/// \throws BadInput when the CRS is none, or the middle of a geographic grid is not between the poles
GroundCell ground_cell(Grid const& grid);

} // namespace thalweg::io
