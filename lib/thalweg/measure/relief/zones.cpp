// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/zones.hpp>

#include <algorithm>
#include <cmath>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/sums.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/same_grid.hpp>
#include <thalweg/measure/relief/internal/horn.hpp>

namespace thalweg::measure {
namespace {

struct Sums {
    CompensatedSum z_m;
    CompensatedSum slope_deg;
    std::int64_t sloping = 0;
    double nearest_m = std::numeric_limits<double>::infinity();
    double farthest_m = 0.0;
};

void close(ZoneRelief& zone, Sums const& sums, double cell_m) {
    if (zone.cells == 0) {
        return;
    }
    double const area_m2 = static_cast<double>(zone.cells) * cell_m * cell_m;
    zone.z_mean_m = sums.z_m.value() / static_cast<double>(zone.cells);
    zone.melton = (zone.z_max_m - zone.z_min_m) / std::sqrt(area_m2);
    if (zone.z_max_m > zone.z_min_m) {
        zone.hypsometric = (zone.z_mean_m - zone.z_min_m) / (zone.z_max_m - zone.z_min_m);
    }
    if (sums.sloping > 0) {
        zone.slope_deg = sums.slope_deg.value() / static_cast<double>(sums.sloping);
    }
    if (sums.farthest_m >= sums.nearest_m) {
        zone.flow_length_m = sums.farthest_m - sums.nearest_m;
    }
    if (zone.flow_length_m > 0.0) {
        zone.form_factor = area_m2 / (zone.flow_length_m * zone.flow_length_m);
    }
}

} // namespace

std::vector<ZoneRelief> zone_relief(Raster<float> const& dem, Raster<std::int32_t> const& zone, std::int64_t zones,
                                    Raster<double> const& outlet_m, Run const& run) {
    for (Grid const& other : {zone.grid(), outlet_m.grid()}) {
        require_same_grid(dem.grid(), other, "measure.zone_relief", "the DEM and its zones or lengths",
                          "give those of this DEM");
    }
    auto const values = zone.values();
    refuse_if<BadInput>(std::ranges::any_of(values, [&](std::int32_t z) { return z >= zones; }), "measure.zone_relief",
                        "a cell has a number that is not below {}", zones);
    auto const offsets = d8_offsets(dem.grid());
    std::vector<ZoneRelief> relief(static_cast<std::size_t>(std::max<std::int64_t>(zones, 0)));
    std::vector<Sums> sums(relief.size());
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (i % cells_between_checks == 0) {
            run.check();
        }
        if (zone[i] < 0 || std::isnan(dem[i])) {
            continue;
        }
        ZoneRelief& r = relief[static_cast<std::size_t>(zone[i])];
        Sums& s = sums[static_cast<std::size_t>(zone[i])];
        auto const z = static_cast<double>(dem[i]);
        r.z_min_m = r.cells == 0 ? z : std::min(r.z_min_m, z);
        r.z_max_m = r.cells == 0 ? z : std::max(r.z_max_m, z);
        ++r.cells;
        s.z_m.add(z);
        if (!std::isnan(outlet_m[i])) {
            s.nearest_m = std::min(s.nearest_m, outlet_m[i]);
            s.farthest_m = std::max(s.farthest_m, outlet_m[i]);
        }
        double const squared = dem.grid().on_border(dem.grid().at(i)) ? std::nan("") : horn_squared(dem, i, offsets);
        if (!std::isnan(squared)) {
            s.slope_deg.add(portable::atan2(std::sqrt(squared), 1.0) * (180.0 / portable::pi));
            ++s.sloping;
        }
    }
    for (std::size_t k = 0; k < relief.size(); ++k) {
        close(relief[k], sums[k], dem.grid().cell_m);
    }
    return relief;
}

} // namespace thalweg::measure
