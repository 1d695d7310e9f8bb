// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/conditioning/internal/flood.hpp>

#include <cmath>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/conditioning/internal/small_step.hpp>
#include <thalweg/flow/internal/priority_flood.hpp>

namespace thalweg::flow {

void flood(Raster<float>& land, Raster<float> const& rivers, Lakes lakes, Run const& run) {
    auto const is_river = [&](std::int64_t i) { return !std::isnan(rivers[i]); };
    auto const rise = [&](float z) { return lakes == Lakes::level ? z : just_above(z); };
    priority_flood(land, is_river, rise, "carve", run);
}

void check_drainable(Raster<float> const& dem, Valley const& valley) {
    Grid const& grid = dem.grid();
    if (grid.cells() == 0) {
        throw BadInput("flow.condition: the land has no cells");
    }
    if (valley.z.grid() != grid) {
        throw BadInput(fmt::format("flow.condition: the valley has {} x {} cells, the land {} x {}; make both on one "
                                   "grid",
                                   valley.z.width(), valley.z.height(), grid.width, grid.height));
    }
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (std::isinf(dem[i]) || (std::isnan(dem[i]) && !std::isnan(valley.z[i]))) {
            Cell const cell = grid.at(i);
            throw BadInput(fmt::format("flow.condition: the height at column {}, row {} is {}", cell.col, cell.row,
                                       std::isinf(dem[i]) ? "infinite; mark cells without data as NaN"
                                                          : "missing, where a river runs"));
        }
    }
}

} // namespace thalweg::flow
