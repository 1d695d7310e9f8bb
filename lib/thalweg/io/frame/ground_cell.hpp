// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include <thalweg/core/grid.hpp>

namespace thalweg::io {

/// What a grid's coordinates count.
enum class GridUnit : std::uint8_t {
    metres,    ///< of a projected CRS
    distorted, ///< metres of a projected CRS whose lengths are off by more than 1 %, as in Web Mercator
    degrees,   ///< of a geographic CRS, in whatever unit of angle
    other,     ///< feet, or metres of a CRS that is not projected
    unknown    ///< there is no CRS
};

/// What ground_cell() returns.
struct GroundCell {
    GridUnit unit = GridUnit::unknown;
    double side_m = 0.0; ///< [m]
    /// As projected_crs gives it: the grid's where the unit is metres, where it is distorted one to warp the grid to,
    /// else "".
    std::string crs;
};

/// How large a grid's cells are on the ground.
/// \param grid any grid with cells above 0
/// \return of a geographic or distorted grid the side of the square as large as a cell in the middle (of a geographic
/// one: in the middle row) on the CRS's ellipsoid; else the cell's own side, in metres where the CRS tells them.
/// \throws BadInput when the CRS is none, the middle of a geographic grid is not between the poles, or a distorted grid
/// spans more than 180 degrees of longitude
GroundCell ground_cell(Grid const& grid);

/// \param grid a grid, its CRS of any kind or ""
/// \return whether its coordinates are metres whose lengths are off by more than 1 % (GridUnit::distorted).
/// \throws BadInput when the CRS is none, or such a grid spans more than 180 degrees of longitude
bool is_distorted(Grid const& grid);

} // namespace thalweg::io
