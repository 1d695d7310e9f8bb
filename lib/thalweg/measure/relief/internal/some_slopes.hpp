// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <thalweg/core/numbers/elementary_rows.hpp>
#include <thalweg/core/raster.hpp>

namespace thalweg::measure {

/// Slopes by Horn's formula of some cells of a row; those of a cell without data are NaN.
struct SomeSlopes {
    static constexpr std::size_t at_once = 256;
    std::array<double, at_once> dx; ///< [-] magnitudes
    std::array<double, at_once> dy;
    std::array<double, at_once> tangent;
    std::array<double, at_once> angle; ///< [rad]

    /// Computes count cells from this one of the row; both neighbours of each are on the grid.
    void compute(Raster<float> const& dem, std::int64_t row, std::size_t first, std::size_t count) {
        float const* const north = dem.row(row - 1).data() + first;
        float const* const here = dem.row(row).data() + first;
        float const* const south = dem.row(row + 1).data() + first;
        double const per_metre = 1.0 / (8.0 * dem.grid().cell_m);
        auto const z = [](float const* line, std::size_t c) { return static_cast<double>(line[c]); };
        for (std::size_t i = 0; i < count; ++i) {
            double const west = z(north - 1, i) + 2.0 * z(here - 1, i) + z(south - 1, i);
            double const east = z(north + 1, i) + 2.0 * z(here + 1, i) + z(south + 1, i);
            double const up = z(north - 1, i) + 2.0 * z(north, i) + z(north + 1, i);
            double const down = z(south - 1, i) + 2.0 * z(south, i) + z(south + 1, i);
            dx[i] = std::fabs(east - west) * per_metre;
            dy[i] = std::fabs(down - up) * per_metre;
            double const steep = std::sqrt(dx[i] * dx[i] + dy[i] * dy[i]);
            tangent[i] = std::isnan(here[i]) ? std::numeric_limits<double>::quiet_NaN() : steep;
        }
        portable::atan2_row({tangent.data(), count}, 1.0, angle);
    }
};

} // namespace thalweg::measure
