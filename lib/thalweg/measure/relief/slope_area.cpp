// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/slope_area.hpp>

#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/numbers/compensated_sum.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/range.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/measure/laws/line_fit.hpp>

namespace thalweg::measure {

namespace {

struct Reach {
    CompensatedSum drop_m;
    CompensatedSum way_m;
    CompensatedSum log_area;
    std::int64_t cells = 0;
};

void check(SlopeAreaParams const& params, Raster<float> const& dem, flow::FlowField const& drainage) {
    constexpr char const* self = "measure.slope_area";
    require_in(self, "support_cells", params.support_cells, Range::at_least(1));
    require_in(self, "bins_per_decade", params.bins_per_decade, Range::between(1, 100));
    require_in(self, "least_places", params.least_places, Range::at_least(1));
    require_in(self, "least_bins", params.least_bins, Range::at_least(3));
    if (!(dem.grid() == drainage.direction.grid())) {
        throw BadInput("measure.slope_area: the DEM and its drainage have different grids; drain this DEM");
    }
}

std::map<std::int64_t, Reach> reaches_by_area(Raster<float> const& dem, flow::FlowField const& drainage,
                                              SlopeAreaParams const& params, Run const& run) {
    double const cell_m = dem.grid().cell_m;
    double const bins_a_fold = params.bins_per_decade / portable::log(10.0);
    auto const offsets = d8_offsets(dem.grid());
    std::map<std::int64_t, Reach> reaches;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (i % cells_between_checks == 0) {
            run.check();
        }
        if (drainage.area_cells[i] < params.support_cells || !goes_on(drainage.direction[i])) {
            continue;
        }
        std::size_t const way = index_of(drainage.direction[i]);
        double const log_area = portable::log(static_cast<double>(drainage.area_cells[i]) * cell_m * cell_m);
        Reach& reach = reaches[static_cast<std::int64_t>(std::floor(log_area * bins_a_fold))];
        reach.drop_m.add(static_cast<double>(dem[i]) - static_cast<double>(dem[i + offsets[way]]));
        reach.way_m.add(cell_m / d8_per_length[way]);
        reach.log_area.add(log_area);
        ++reach.cells;
    }
    return reaches;
}

} // namespace

std::optional<PowerLaw> slope_area(Raster<float> const& dem, flow::FlowField const& drainage,
                                   SlopeAreaParams const& params, Run const& run) {
    check(params, dem, drainage);
    PowerLaw law;
    std::vector<Vec2> line;
    std::vector<double> weights;
    for (auto const& [number, reach] : reaches_by_area(dem, drainage, params, run)) {
        double const slope = reach.drop_m.value() / reach.way_m.value();
        if (reach.cells < params.least_places || !(slope > 0.0)) {
            law.left_out += reach.cells;
            continue;
        }
        double const log_area = reach.log_area.value() / static_cast<double>(reach.cells);
        line.push_back({log_area, portable::log(slope)});
        weights.push_back(std::sqrt(static_cast<double>(reach.cells)));
        law.bins.push_back({portable::exp(log_area), slope, reach.cells});
        law.places += reach.cells;
    }
    return with_line(std::move(law), fit_line(line, weights), params.least_bins);
}

} // namespace thalweg::measure
