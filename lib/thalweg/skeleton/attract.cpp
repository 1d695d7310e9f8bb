// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/attract.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <thalweg/core/cells/cells_around.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/range.hpp>

namespace thalweg::skeleton {

Raster<float> attract(Raster<float> dem, Attraction const& attraction) {
    Cell const centre = attraction.centre;
    if (!dem.grid().contains(centre)) {
        throw BadParameter(fmt::format("skeleton.attract: column {}, row {} is off the grid of {} x {} cells",
                                       centre.col, centre.row, dem.width(), dem.height()));
    }
    require_in("skeleton.attract", "radius", attraction.radius_cells, Range::above(0.0).or_infinite(), "cells");
    require_in("skeleton.attract", "height", attraction.z, Range::finite(), "m");
    double const square = attraction.radius_cells * attraction.radius_cells;
    double const at_radius = attraction.falloff == Falloff::literal ? 0.0 : portable::exp(-1.0);
    auto const reach = static_cast<std::int64_t>(std::min(attraction.radius_cells, 1e9));
    cells_around(dem.grid(), centre, reach, [&](Cell c) {
        auto const distance = static_cast<double>(squared_cells(c, centre));
        if (distance <= square) {
            double const h = dem[c];
            double const pull = (portable::exp(-distance / square) - at_radius) / (1.0 - at_radius);
            dem[c] = static_cast<float>(h + pull * (attraction.z - h));
        }
    });
    if (!std::isnan(dem[centre])) {
        dem[centre] = static_cast<float>(attraction.z);
    }
    return dem;
}

} // namespace thalweg::skeleton
