// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/relief.hpp>

#include <algorithm>
#include <cmath>

#include <thalweg/core/numbers/sums.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>

namespace thalweg::measure {
namespace {

double share(std::array<double, form_count> const& shares, Form form) {
    return shares[static_cast<std::size_t>(form) - 1];
}

/// Length of rivers over the area of all cells with data.
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

constexpr double wide = 1.5;     // regions differ more than the two reference DEMs
constexpr double wider = 2.0;    // finer textures are common
constexpr double widest = 5.0;   // one plain is enough to change it
constexpr double ten_dems = 1.0; // wide_references: they are of ten kinds of land
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

double over(std::int64_t a, std::int64_t b) {
    return b > 0 ? static_cast<double>(a) / static_cast<double>(b) : unknown;
}

double interquartile(Relief const& relief) {
    auto const& at = relief.slopes.percentile_deg;
    return (at[4] - at[2]) / at[3];
}

constexpr std::array<ReliefMetric, relief_metric_count> figures = {{
    {"slope_mean", "slope, mean", "°", Judges::yes, [](Relief const& r) { return r.slopes.mean_deg; }},
    {"slope_std", "slope, deviation", "°", Judges::yes, [](Relief const& r) { return r.slopes.std_deg; }},
    {"slope_p5", "slope, 5th percentile", "°", Judges::yes,
     [](Relief const& r) { return r.slopes.percentile_deg.front(); }},
    {"slope_p50", "slope, median", "°", Judges::yes, [](Relief const& r) { return r.slopes.percentile_deg[3]; }},
    {"slope_p95", "slope, 95th percentile", "°", Judges::yes,
     [](Relief const& r) { return r.slopes.percentile_deg.back(); }},
    {"slope_cv", "slope, variation of the tangent", "", Judges::yes,
     [](Relief const& r) { return r.slopes.tangent_cv; }},
    {"theta", "concavity θ of the DEM’s rivers", "", Judges::yes,
     [](Relief const& r) { return r.slope_area ? -r.slope_area->exponent : unknown; }},
    {"theta_r2", "slope against area, r²", "", Judges::yes,
     [](Relief const& r) { return r.slope_area ? r.slope_area->r2 : unknown; }},
    {"chi_r2", "height against χ on main stems, r²", "", Judges::yes,
     [](Relief const& r) { return r.chi ? r.chi->r2 : unknown; }},
    {"hypsometric_integral", "hypsometric integral", "", Judges::yes,
     [](Relief const& r) { return r.hypsometric_integral; }},
    {"peaks", "peaks per thousand cells", "", Judges::yes,
     [](Relief const& r) { return 1000.0 * over(r.extremes.peaks, r.extremes.cells); }},
    {"pits_over_peaks", "pits over peaks", "", Judges::no,
     [](Relief const& r) { return over(r.extremes.pits, r.extremes.peaks); }},
    {"valleys_over_ridges", "valley over ridge cells", "", Judges::yes,
     [](Relief const& r) { return r.valleys_over_ridges; }},
    {"hollows_over_noses", "hollow over nose cells", "", Judges::yes,
     [](Relief const& r) { return r.hollows_over_noses; }},
    {"aspects_along_grid", "aspects along the grid, over even ones", "", Judges::yes,
     [](Relief const& r) { return r.slopes.aspects_along_grid; }},
    {"aspects_on_grid", "D8 bias: aspects right on the grid", "", Judges::yes,
     [](Relief const& r) { return r.slopes.aspects_on_grid; }},
    {"length_x", "correlation length over extent, rows", "", Judges::yes, [](Relief const& r) { return r.length_x; }},
    {"length_y", "correlation length over extent, columns", "", Judges::yes,
     [](Relief const& r) { return r.length_y; }},
    {"density", "drainage density × √support", "", Judges::yes, [](Relief const& r) { return r.scaled_density; }},
    {"slope_area_ratio", "slope of channels over that of hillslopes", "", Judges::yes,
     [](Relief const& r) { return r.slope_area_ratio; }, wide},
    {"gradient_correlation_360", "correlation of unit gradients, 360 m apart", "", Judges::yes,
     [](Relief const& r) { return r.texture.correlation[0]; }, wider},
    {"gradient_correlation_720", "correlation of unit gradients, 720 m apart", "", Judges::yes,
     [](Relief const& r) { return r.texture.correlation[1]; }, wider},
    {"gradient_correlation_1440", "correlation of unit gradients, 1440 m apart", "", Judges::no,
     [](Relief const& r) { return r.texture.correlation[2]; }},
    {"gradient_anisotropy", "anisotropy of gradients within 1 km", "", Judges::yes,
     [](Relief const& r) { return r.texture.anisotropy; }, wide},
    {"straight_run", "longest straight run of a channel", "cells", Judges::large_values,
     [](Relief const& r) { return static_cast<double>(r.straight.longest_run); }},
    {"straight_share", "share of straight channel reaches", "", Judges::no,
     [](Relief const& r) { return r.straight.straight_share; }},
    {"level_patch", "largest patch below 3°", "%", Judges::yes,
     [](Relief const& r) { return 100.0 * over(r.level_patch.cells, r.level_patch.land); }, widest},
    {"prominent_peaks", "peaks of 30 m prominence", "per km²", Judges::yes,
     [](Relief const& r) { return r.orometry.peaks_per_km2; }},
    {"prominence", "prominence of these, median", "m", Judges::yes,
     [](Relief const& r) { return r.orometry.median_prominence_m; }},
    {"isolation", "isolation of these, median", "m", Judges::yes,
     [](Relief const& r) { return r.orometry.median_isolation_m; }},
    {"slope_spread", "mean slope in windows of 3 km, deviation", "°", Judges::yes,
     [](Relief const& r) { return r.variety.slope_spread_deg; }, ten_dems},
    {"slope_iqr", "slope, interquartile range over median", "", Judges::yes, interquartile, ten_dems},
    {"gentle_away", "land below 4° away from rivers", "%", Judges::yes,
     [](Relief const& r) { return 100.0 * r.variety.gentle_away_share; }, ten_dems},
    {"half_way_height", "height of main stems half-way, over their source", "", Judges::yes,
     [](Relief const& r) { return r.variety.half_way_height; }, ten_dems},
    {"canals", "river cells between steep banks", "%", Judges::large_values,
     [](Relief const& r) { return 100.0 * r.variety.canal_share(); }, ten_dems, 0.1},
    {"steepest_drop", "greatest drops over 1 km, over the 90th percentile", "", Judges::large_values,
     [](Relief const& r) { return r.variety.steepest_drop; }, ten_dems},
}};

#include <thalweg/measure/relief/internal/reference_dems.inc>
#include <thalweg/measure/relief/internal/wide_references.inc>

constexpr std::array<NaturalRange, 9> ranges = {{
    {"bifurcation", 3.0, 5.0, "Strahler 1964: basins whose pattern the rock does not distort"},
    {"length", 1.5, 3.5, "Rodríguez-Iturbe and Valdés 1979, after Smart 1972: natural basins"},
    {"area", 3.0, 6.0, "Rodríguez-Iturbe and Valdés 1979, after Smart 1972 and Schumm 1956: natural basins"},
    {"tokunaga_a", 1.0, 1.5, "Dodds and Rothman 1999: compiled from maps and DEMs, after Tokunaga 1978"},
    {"tokunaga_c", 2.0, 3.0, "Dodds and Rothman 1999: compiled from maps and DEMs, after Tokunaga 1978"},
    {"hack", 0.52, 0.60, "Rigon et al. 1996: DEMs; Hack 1957: 0.6, Shenandoah Valley"},
    {"concavity", 0.3, 0.6,
     "Whipple and Tucker 1999; Gailleton et al. 2021: median 0.425, quartiles 0.225 and 0.575 of mountain basins"},
    {"drainage_density", 0.55, 374.0,
     "Langbein 1947: from 0.55 to 2.09 in humid lands, on maps; Schumm 1956: 374 in badlands, surveyed"},
    {"junction_angle", 45.0, 72.0,
     "Seybold, Rothman and Kirchner 2017: arid to humid, a million junctions of the United States; Devauchelle et al. "
     "2012: 72 where springs cut the valleys"},
}};

} // namespace

Relief relief(Raster<float> const& dem, flow::FlowField const& drainage, Statistics const& statistics,
              ReliefParams const& params, Run const& run) {
    return relief(dem, drainage, statistics, std::span<std::int64_t const>(), params, run);
}

Relief relief(Raster<float> const& dem, flow::FlowField const& drainage, Statistics const& statistics,
              std::span<std::int64_t const> rivers, ReliefParams const& params, Run const& run) {
    refuse_if<BadInput>(statistics.cells + statistics.nodata != dem.cells(), "measure.relief",
                        "statistics of {} cells for a DEM of {}; measure this DEM",
                        statistics.cells + statistics.nodata, dem.cells());
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
    found.straight = straight_channels(drainage, dem, params.straight, run);
    found.level_patch = level_patch(dem, params.level_patch, run);
    found.orometry = orometry(dem, params.orometry, run);
    found.variety = variety(dem, drainage, rivers, params.variety, run);
    return found;
}

double total_variation(std::array<double, form_count> const& a, std::array<double, form_count> const& b) {
    double sum = 0.0;
    for (std::size_t f = 0; f < form_count; ++f) {
        sum += std::fabs(a[f] - b[f]);
    }
    return 0.5 * sum;
}

std::array<ReliefMetric, relief_metric_count> const& relief_metrics() {
    return figures;
}

std::span<ReferenceDem const> reference_dems() {
    return lands;
}

std::array<double, form_count> mean_forms() {
    std::array<double, form_count> mean{};
    for (ReferenceDem const& land : lands) {
        for (std::size_t f = 0; f < form_count; ++f) {
            mean[f] += land.forms[f] / static_cast<double>(lands.size());
        }
    }
    return mean;
}

ReliefRange relief_range(std::size_t figure) {
    ReliefMetric const& metric = relief_metrics()[figure];
    auto const range = [&](auto const& dems, std::size_t at) {
        auto const [least, greatest] = std::minmax_element(
            dems.begin(), dems.end(), [&](auto const& a, auto const& b) { return a.figures[at] < b.figures[at]; });
        return ReliefRange{metric.judges == Judges::large_values ? 0.0 : least->figures[at] / metric.tolerance,
                           greatest->figures[at] * metric.tolerance + metric.margin};
    };
    constexpr std::size_t first_wide = relief_metric_count - wide_metric_count;
    return figure < first_wide ? range(lands, figure) : range(wide_lands, figure - first_wide);
}

std::span<NaturalRange const> natural_ranges() {
    return ranges;
}

NaturalRange const* natural_range(std::string_view law) {
    auto const at = std::find_if(ranges.begin(), ranges.end(), [&](NaturalRange const& r) { return r.law == law; });
    return at == ranges.end() ? nullptr : &*at;
}

} // namespace thalweg::measure
