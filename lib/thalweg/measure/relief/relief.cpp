// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/relief.hpp>

#include <cmath>

#include <fmt/format.h>

#include <thalweg/core/numbers/compensated_sum.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/range.hpp>

namespace thalweg::measure {

namespace {

double share(std::array<double, form_count> const& shares, Form form) {
    return shares[static_cast<std::size_t>(form) - 1];
}

/// Rivers' length over the area of all cells with data.
double density(flow::FlowField const& drainage, std::int64_t cells, std::int64_t support_cells) {
    double const cell_m = drainage.direction.grid().cell_m;
    CompensatedSum length;
    for (std::int64_t i = 0; i < drainage.direction.cells(); ++i) {
        if (drainage.area_cells[i] >= support_cells && goes_on(drainage.direction[i])) {
            length.add(cell_m / d8_per_length[index_of(drainage.direction[i])]);
        }
    }
    return length.value() / (static_cast<double>(cells) * cell_m * cell_m);
}

} // namespace

Relief relief(Raster<float> const& dem, flow::FlowField const& drainage, Statistics const& statistics,
              ReliefParams const& params, Run const& run) {
    if (statistics.cells + statistics.nodata != dem.cells()) {
        throw BadInput(fmt::format("measure.relief: statistics of {} cells for a DEM of {}; measure this DEM",
                                   statistics.cells + statistics.nodata, dem.cells()));
    }
    require_in("measure.relief", "support_cells", params.support_cells, Range::at_least(1));
    Relief found;
    found.slope_area = slope_area(dem, drainage, params.slope_area, run);
    found.chi = chi(dem, drainage, params.chi, run);
    found.slopes = slopes(dem, run);
    found.extremes = local_extremes(dem, run);
    double const range = statistics.max.z - statistics.min.z;
    found.hypsometric_integral = range > 0.0 ? (statistics.mean - statistics.min.z) / range : 0.5;
    found.forms = geomorphons(dem, params.geomorphons, run).shares;
    auto const of = [&](Form form) { return share(found.forms, form); };
    double const noses = of(Form::peak) + of(Form::ridge) + of(Form::shoulder) + of(Form::spur);
    double const hollows = of(Form::hollow) + of(Form::footslope) + of(Form::valley) + of(Form::pit);
    found.valleys_over_ridges = of(Form::valley) / of(Form::ridge);
    found.hollows_over_noses = hollows / noses;
    found.length_x = statistics.lx.cells / static_cast<double>(dem.width());
    found.length_y = statistics.ly.cells / static_cast<double>(dem.height());
    found.support_cells = params.support_cells;
    found.drainage_density = density(drainage, statistics.cells, params.support_cells);
    found.scaled_density =
        found.drainage_density * std::sqrt(static_cast<double>(params.support_cells)) * dem.grid().cell_m;
    found.slope_area_ratio = slope_area_ratio(dem, drainage, params.slope_area_ratio, run);
    found.texture = gradient_texture(dem, params.texture, run);
    found.straight = straight_channels(drainage, params.straight, run);
    found.level_patch = level_patch(dem, params.level_patch, run);
    found.orometry = orometry(dem, params.orometry, run);
    return found;
}

double total_variation(std::array<double, form_count> const& a, std::array<double, form_count> const& b) {
    double sum = 0.0;
    for (std::size_t f = 0; f < form_count; ++f) {
        sum += std::fabs(a[f] - b[f]);
    }
    return 0.5 * sum;
}

} // namespace thalweg::measure
