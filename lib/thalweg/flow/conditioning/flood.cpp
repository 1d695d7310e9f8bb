// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/conditioning/internal/flood.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/conditioning/internal/small_step.hpp>
#include <thalweg/flow/internal/flood_queue.hpp>

namespace thalweg::flow {

void flood(Raster<float>& land, Raster<float> const& rivers, Lakes lakes, Run const& run) {
    Mask reached(land.grid());
    auto const offsets = d8_offsets(land.grid());
    FloodQueue queue;
    for (std::int64_t i = 0; i < land.cells(); ++i) {
        if (std::isnan(land[i])) {
            reached[i] = 1;
        } else if (!std::isnan(rivers[i]) || std::any_of(offsets.begin(), offsets.end(), [&](std::int64_t step) {
                       return std::isnan(land[i + step]);
                   })) {
            reached[i] = 1;
            queue.push(land[i], i);
        }
    }
    std::int64_t popped = 0;
    for (std::int64_t i = queue.pop(); i >= 0; i = queue.pop()) {
        if (++popped % cells_between_checks == 0) {
            run.at(static_cast<double>(popped) / static_cast<double>(land.cells()), "carve");
        }
        float const level = lakes == Lakes::level ? land[i] : just_above(land[i]);
        for (std::int64_t const step : offsets) {
            std::int64_t const n = i + step;
            if (reached[n] == 0) {
                reached[n] = 1;
                land[n] = std::max(land[n], level);
                queue.push(land[n], n);
            }
        }
    }
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
