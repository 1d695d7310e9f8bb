// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

#include <thalweg/core/cells.hpp>

namespace thalweg::measure {

/// How much a DEM rises a metre.
struct Gradient {
    double east = 0.0;
    double south = 0.0;
};

/// The gradient by Horn's formula.
/// \param dem [m] by cell; NaN: no data
/// \param i a cell with eight neighbours on the grid
/// \param to d8_offsets of the grid
/// \return [-] NaN where a neighbour has no data
inline Gradient horn_gradient(Raster<float> const& dem, std::int64_t i, std::array<std::int64_t, 8> const& to) {
    std::array<double, 8> z{}; // E, SE, S, SW, W, NW, N, NE
    for (std::size_t k = 0; k < z.size(); ++k) {
        z[k] = static_cast<double>(dem[i + to[k]]);
    }
    return {(z[7] + 2.0 * z[0] + z[1] - z[5] - 2.0 * z[4] - z[3]) / (8.0 * dem.grid().cell_m),
            (z[3] + 2.0 * z[2] + z[1] - z[5] - 2.0 * z[6] - z[7]) / (8.0 * dem.grid().cell_m)};
}

/// The square of the tangent of the slope by Horn's formula.
/// \param dem,i,to as horn_gradient
/// \return [-] NaN where a neighbour has no data
inline double horn_squared(Raster<float> const& dem, std::int64_t i, std::array<std::int64_t, 8> const& to) {
    Gradient const rise = horn_gradient(dem, i, to);
    return rise.east * rise.east + rise.south * rise.south;
}

} // namespace thalweg::measure
