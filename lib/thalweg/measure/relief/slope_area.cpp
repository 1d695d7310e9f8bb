// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/slope_area.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/sums.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/same_grid.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/measure/relief/internal/horn.hpp>
#include <thalweg/measure/relief/internal/main_stems.hpp>

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
    require_same_grid(dem.grid(), drainage.direction.grid(), "measure.slope_area", "the DEM and its drainage",
                      "drain this DEM");
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

void check(ChiParams const& params, Raster<float> const& dem, flow::FlowField const& drainage) {
    constexpr char const* self = "measure.chi";
    require_in(self, "theta", params.theta, Range::between(0.0, 2.0));
    require_in(self, "support_cells", params.support_cells, Range::at_least(1));
    require_in(self, "least_cells", params.least_cells, Range::at_least(3));
    require_in(self, "most_stems", params.most_stems, Range::at_least(1));
    require_same_grid(dem.grid(), drainage.direction.grid(), "measure.chi", "the DEM and its drainage",
                      "drain this DEM");
}

/// Chi and height along the stem upstream of a mouth.
std::vector<Vec2> stem_above(Raster<float> const& dem, flow::FlowField const& drainage, std::int64_t mouth,
                             ChiParams const& params) {
    Grid const& grid = dem.grid();
    std::vector<Vec2> stem{{0.0, static_cast<double>(dem[mouth])}};
    each_cell_above(drainage, mouth, params.support_cells, [&](Cell at, std::size_t way) {
        double const area_m2 = static_cast<double>(drainage.area_cells[at]) * grid.cell_m * grid.cell_m;
        double const step = grid.cell_m / d8_per_length[way] * portable::pow(area_m2, -params.theta);
        stem.push_back({stem.back().x + step, static_cast<double>(dem[at])});
    });
    return stem;
}

/// Sum of squared deviations of heights from their mean.
double spread(std::vector<Vec2> const& stem) {
    CompensatedSum sum;
    for (Vec2 const p : stem) {
        sum.add(p.y);
    }
    double const mean = sum.value() / static_cast<double>(stem.size());
    CompensatedSum squares;
    for (Vec2 const p : stem) {
        squares.add((p.y - mean) * (p.y - mean));
    }
    return squares.value();
}

struct Tangents {
    CompensatedSum sum;
    std::int64_t cells = 0;

    void add(double tangent) {
        sum.add(tangent);
        ++cells;
    }
    double mean() const {
        return cells > 0 ? sum.value() / static_cast<double>(cells) : std::numeric_limits<double>::quiet_NaN();
    }
};

void check(SlopeAreaRatioParams const& params, Raster<float> const& dem, flow::FlowField const& drainage) {
    constexpr char const* self = "measure.slope_area_ratio";
    require_in(self, "hillslope_from", params.hillslope_from, Range::at_least(1));
    require_in(self, "hillslope_to", params.hillslope_to, Range::above(static_cast<double>(params.hillslope_from)));
    require_in(self, "channel_from", params.channel_from, Range::at_least(1));
    require_in(self, "channel_to", params.channel_to, Range::above(static_cast<double>(params.channel_from)));
    require_same_grid(dem.grid(), drainage.direction.grid(), "measure.slope_area_ratio", "the DEM and its drainage",
                      "drain this DEM");
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

std::optional<Chi> chi(Raster<float> const& dem, flow::FlowField const& drainage, ChiParams const& params,
                       Run const& run) {
    check(params, dem, drainage);
    Chi found;
    found.theta = params.theta;
    CompensatedSum explained;
    CompensatedSum all;
    for (std::int64_t const mouth : mouths(drainage, params.support_cells)) {
        run.check();
        if (found.stems == params.most_stems) {
            break;
        }
        std::vector<Vec2> const stem = stem_above(dem, drainage, mouth, params);
        auto const cells = static_cast<std::int64_t>(stem.size());
        auto const fit = fit_line(stem);
        double const squares = spread(stem);
        if (cells < params.least_cells || !fit || !(squares > 0.0)) {
            continue;
        }
        if (found.stems == 0) {
            found.main_r2 = fit->r2;
            found.main_steepness = fit->slope;
        }
        explained.add(fit->r2 * squares);
        all.add(squares);
        ++found.stems;
        found.cells += cells;
    }
    if (found.stems == 0) {
        return std::nullopt;
    }
    found.r2 = explained.value() / all.value();
    return found;
}

double slope_area_ratio(Raster<float> const& dem, flow::FlowField const& drainage, SlopeAreaRatioParams const& params,
                        Run const& run) {
    check(params, dem, drainage);
    auto const offsets = d8_offsets(dem.grid());
    Tangents hillslopes;
    Tangents channels;
    for (std::int64_t r = 1; r + 1 < dem.height(); ++r) {
        run.check();
        for (std::int64_t c = 1; c + 1 < dem.width(); ++c) {
            std::int64_t const i = dem.grid().index({c, r});
            std::int64_t const area = drainage.area_cells[i];
            bool const hillslope = area >= params.hillslope_from && area < params.hillslope_to;
            bool const channel = area >= params.channel_from && area < params.channel_to;
            if (!hillslope && !channel) {
                continue;
            }
            double const tangent = std::sqrt(horn_squared(dem, i, offsets));
            if (hillslope && !std::isnan(tangent)) {
                hillslopes.add(tangent);
            }
            if (channel && !std::isnan(tangent)) {
                channels.add(tangent);
            }
        }
    }
    double const hillslope = hillslopes.mean();
    return hillslope > 0.0 ? channels.mean() / hillslope : std::numeric_limits<double>::quiet_NaN();
}

} // namespace thalweg::measure
