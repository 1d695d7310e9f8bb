// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/perched.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/range.hpp>

namespace thalweg::measure {

namespace {

double lowest_of_second_ring(Raster<float> const& dem, Cell at) {
    double lowest = std::numeric_limits<double>::infinity();
    for (std::int64_t row = -2; row <= 2; ++row) {
        for (std::int64_t col = -2; col <= 2; ++col) {
            Cell const there{at.col + col, at.row + row};
            bool const in_ring = std::max(std::abs(row), std::abs(col)) == 2;
            if (in_ring && dem.grid().contains(there) && !std::isnan(dem[there])) {
                lowest = std::min(lowest, static_cast<double>(dem[there]));
            }
        }
    }
    return lowest;
}

} // namespace

std::vector<std::int64_t> perched(Raster<float> const& dem, std::span<std::int64_t const> cells, double rise_m) {
    require_in("measure.perched", "rise_m", rise_m, Range::at_least(0.0));
    std::vector<std::int64_t> found;
    for (std::int64_t const cell : cells) {
        if (cell < 0 || cell >= dem.cells()) {
            throw BadInput(fmt::format("measure.perched: cell {} is not one of the DEM's {}", cell, dem.cells()));
        }
        if (static_cast<double>(dem[cell]) - lowest_of_second_ring(dem, dem.grid().at(cell)) > rise_m) {
            found.push_back(cell);
        }
    }
    return found;
}

} // namespace thalweg::measure
