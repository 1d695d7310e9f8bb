// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/relief_metrics.hpp>

#include <limits>

namespace thalweg::measure {

namespace {

constexpr double wide = 1.5;   // regions differ more than the two reference DEMs do
constexpr double wider = 2.0;  // of land with finer texture there is more
constexpr double widest = 5.0; // one plain makes the difference
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

double over(std::int64_t a, std::int64_t b) {
    return b > 0 ? static_cast<double>(a) / static_cast<double>(b) : unknown;
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
}};

} // namespace

std::array<ReliefMetric, relief_metric_count> const& relief_metrics() {
    return figures;
}

} // namespace thalweg::measure
