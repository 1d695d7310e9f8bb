// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/run.hpp>

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

/// Calls visit(cell, gradient) for each cell that has a height and a gradient; cells on the border have none.
/// \param visit called as visit(std::int64_t, Gradient), by several threads
template <class Visit> void each_gradient(Raster<float> const& dem, Run const& run, Visit const& visit) {
    auto const offsets = d8_offsets(dem.grid());
    parallel_ranges(run, std::max<std::int64_t>(dem.height() - 2, 0), 64, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin + 1; row < end + 1; ++row) {
            run.check();
            for (std::int64_t col = 1; col + 1 < dem.width(); ++col) {
                std::int64_t const i = dem.grid().index({col, row});
                Gradient const rise = horn_gradient(dem, i, offsets);
                if (!std::isnan(dem[i]) && !std::isnan(rise.east) && !std::isnan(rise.south)) {
                    visit(i, rise);
                }
            }
        }
    });
}

} // namespace thalweg::measure
