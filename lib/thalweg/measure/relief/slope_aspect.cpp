// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/slope_aspect.hpp>

#include <cmath>
#include <limits>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/measure/relief/internal/horn.hpp>

namespace thalweg::measure {
namespace {

constexpr double degrees = 180.0 / portable::pi;

/// A number [deg] for each cell with a gradient.
template <class OfGradient>
Raster<float> by_gradient(Raster<float> const& dem, char const* where, OfGradient of_gradient, Run const& run) {
    refuse_if<BadInput>(dem.cells() > 0 && !(dem.grid().cell_m > 0.0), where,
                        "the DEM's cells have a side of {} m; it must be greater than 0", dem.grid().cell_m);
    Raster<float> found(dem.grid(), std::numeric_limits<float>::quiet_NaN());
    each_gradient(dem, run, [&](std::int64_t i, Gradient rise) { found[i] = static_cast<float>(of_gradient(rise)); });
    return found;
}

} // namespace

Raster<float> slope(Raster<float> const& dem, Run const& run) {
    return by_gradient(
        dem, "measure.slope",
        [](Gradient rise) {
            return portable::atan2(std::sqrt(rise.east * rise.east + rise.south * rise.south), 1.0) * degrees;
        },
        run);
}

Raster<float> aspect(Raster<float> const& dem, Run const& run) {
    return by_gradient(
        dem, "measure.aspect",
        [](Gradient rise) {
            if (rise.east == 0.0 && rise.south == 0.0) {
                return std::numeric_limits<double>::quiet_NaN();
            }
            double const clockwise = portable::atan2(-rise.east, rise.south) * degrees;
            auto const turned = static_cast<float>(clockwise < 0.0 ? clockwise + 360.0 : clockwise);
            return turned < 360.0F ? static_cast<double>(turned) : 0.0;
        },
        run);
}

} // namespace thalweg::measure
