// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/wetness.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/same_grid.hpp>
#include <thalweg/measure/relief/internal/horn.hpp>

namespace thalweg::measure {

Raster<double> wetness(Raster<float> const& dem, Raster<double> const& area_cells, WetnessParams const& params,
                       Run const& run) {
    require_in("measure.wetness", "least_slope", params.least_slope, Range::above(0.0));
    require_same_grid(dem.grid(), area_cells.grid(), "measure.wetness: the DEM and its areas", "route this DEM");
    Raster<double> index(dem.grid(), std::numeric_limits<double>::quiet_NaN());
    auto const offsets = d8_offsets(dem.grid());
    parallel_ranges(run, std::max<std::int64_t>(dem.height() - 2, 0), 64, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin + 1; row < end + 1; ++row) {
            for (std::int64_t col = 1; col + 1 < dem.width(); ++col) {
                std::int64_t const i = dem.grid().index({col, row});
                double const squared = horn_squared(dem, i, offsets);
                if (std::isnan(squared) || std::isnan(dem[i])) {
                    continue;
                }
                double const slope = std::max(std::sqrt(squared), params.least_slope);
                index[i] = portable::log(area_cells[i] * dem.grid().cell_m / slope);
            }
        }
    });
    return index;
}

} // namespace thalweg::measure
