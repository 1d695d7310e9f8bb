// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/solver/grid/poisson.hpp>

/// Problems to solve, for tests and bench.
namespace test {

using namespace thalweg;

/// Winding rivers and ridges of about 150 to 950 m through a share of the cells of a square; all others are free.
inline solver::GridProblem winding_lines(std::int64_t side, double share) {
    Grid const grid{side, side, 1.0, 0.0, 0.0, ""};
    solver::GridProblem problem{Raster<std::uint8_t>(grid, solver::free_cell), Raster<double>(grid), {}};
    RandomStream random(7, 1, 0);
    auto const size = static_cast<double>(side);
    auto wanted = static_cast<std::int64_t>(share * size * size);
    while (wanted > 0) {
        double x = random.real() * size;
        double y = random.real() * size;
        double bearing = 6.28 * random.real();
        double const step_m = random.real() < 0.5 ? 60.0 : -60.0;
        auto const length = static_cast<std::int64_t>(200.0 + random.real() * size / 4.0);
        for (std::int64_t i = 0; i < length; ++i) {
            x += std::cos(bearing);
            y += std::sin(bearing);
            bearing += 0.6 * (random.real() - 0.5);
            Cell const cell{static_cast<std::int64_t>(std::floor(x)), static_cast<std::int64_t>(std::floor(y))};
            if (!grid.contains(cell)) {
                break;
            }
            wanted -= problem.kind[cell] == solver::fixed_cell ? 0 : 1;
            problem.kind[cell] = solver::fixed_cell;
            problem.value[cell] = 500.0 + 200.0 * std::sin(8.0 * x / size) + 150.0 * std::cos(10.0 * y / size) +
                                  step_m + 0.05 * static_cast<double>(i);
        }
    }
    return problem;
}

} // namespace test
