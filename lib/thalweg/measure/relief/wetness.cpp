// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/wetness.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/same_grid.hpp>
#include <thalweg/measure/relief/internal/horn.hpp>

namespace thalweg::measure {

Raster<double> wetness(Raster<float> const& dem, Raster<double> const& area_cells, WetnessParams const& params,
                       Run const& run) {
    require_in("measure.wetness", "least_slope", params.least_slope, Range::above(0.0));
    require_same_grid(dem.grid(), area_cells.grid(), "measure.wetness", "the DEM and its areas", "route this DEM");
    Raster<double> index(dem.grid(), std::numeric_limits<double>::quiet_NaN());
    each_gradient(dem, run, [&](std::int64_t i, Gradient rise) {
        double const slope = std::max(std::sqrt(rise.east * rise.east + rise.south * rise.south), params.least_slope);
        index[i] = portable::log(area_cells[i] * dem.grid().cell_m / slope);
    });
    return index;
}

} // namespace thalweg::measure
