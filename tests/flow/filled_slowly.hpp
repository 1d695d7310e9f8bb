// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/flow/route.hpp>

/// The filled DEM by the definition: lower a flood until each cell stands at the least level of any way out.
inline std::vector<double> filled_slowly(thalweg::Raster<float> const& dem) {
    using namespace thalweg;
    Grid const& grid = dem.grid();
    std::vector<double> level(static_cast<std::size_t>(grid.cells()), std::numeric_limits<double>::infinity());
    for (bool changed = true; changed;) {
        changed = false;
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            if (std::isnan(dem[i])) {
                continue;
            }
            double lowest_beside = std::numeric_limits<double>::infinity();
            for (Cell const step : d8_steps) {
                Cell const n{grid.at(i).col + step.col, grid.at(i).row + step.row};
                bool const out = !grid.contains(n) || std::isnan(dem[n]);
                lowest_beside = std::min(lowest_beside, out ? -1e300 : level[static_cast<std::size_t>(grid.index(n))]);
            }
            double const spills = std::max<double>(dem[i], lowest_beside);
            double& here = level[static_cast<std::size_t>(i)];
            changed = changed || spills < here;
            here = std::min(here, spills);
        }
    }
    return level;
}
