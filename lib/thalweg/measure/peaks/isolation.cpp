// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/peaks/isolation.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <thalweg/core/cells/cells_around.hpp>
#include <thalweg/core/run/error.hpp>

namespace thalweg::measure {

namespace {

constexpr std::int64_t none_yet = std::numeric_limits<std::int64_t>::max();

/// The least square of a distance to a higher cell among those of the ring, in cells.
std::int64_t nearest_of_ring(Raster<float> const& dem, Cell at, std::int64_t ring) {
    std::int64_t nearest = none_yet;
    auto const look = [&](Cell there) {
        if (dem.grid().contains(there) && dem[there] > dem[at]) {
            nearest = std::min(nearest, squared_cells(at, there));
        }
    };
    for (std::int64_t k = -ring; k <= ring; ++k) {
        look({at.col + k, at.row - ring});
        look({at.col + k, at.row + ring});
        look({at.col - ring, at.row + k});
        look({at.col + ring, at.row + k});
    }
    return nearest;
}

} // namespace

double isolation(Raster<float> const& dem, std::int64_t cell) {
    if (cell < 0 || cell >= dem.cells()) {
        throw BadInput(fmt::format("measure.isolation: cell {} is not one of the DEM's {}", cell, dem.cells()));
    }
    Cell const at = dem.grid().at(cell);
    std::int64_t const last = std::max({at.col, at.row, dem.width() - 1 - at.col, dem.height() - 1 - at.row});
    std::int64_t nearest = none_yet;
    for (std::int64_t ring = 1; ring <= last && (nearest == none_yet || ring * ring < nearest); ++ring) {
        nearest = std::min(nearest, nearest_of_ring(dem, at, ring));
    }
    return nearest == none_yet ? std::numeric_limits<double>::quiet_NaN()
                               : std::sqrt(static_cast<double>(nearest)) * dem.grid().cell_m;
}

} // namespace thalweg::measure
