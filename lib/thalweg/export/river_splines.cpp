// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/export/internal/river_splines.hpp>

#include <algorithm>
#include <cmath>

#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/route.hpp>

namespace thalweg::exports {
namespace {

std::vector<double> areas_at_ends(report::Scene const& scene, Run const& run) {
    std::size_t const arcs = scene.network->planform.arc_count();
    if (scene.ds_area_m2.size() == arcs &&
        std::ranges::all_of(scene.ds_area_m2, [](double area) { return area > 0.0; })) {
        return scene.ds_area_m2;
    }
    return flow::areas_d8(scene.network->planform, flow::route(*scene.dem, run), run).ds_area_m2;
}

} // namespace

std::vector<RiverSpline> river_splines(report::Scene const& scene, double runoff_mm, Run const& run) {
    StreamNetwork const& network = scene.network->planform;
    std::vector<double> const ends = areas_at_ends(scene, run);
    double const cell_m = scene.dem->grid().cell_m;
    constexpr double seconds_of_a_year = 31557600.0;
    double const discharge_of_m2 = runoff_mm / 1000.0 / seconds_of_a_year;
    std::vector<RiverSpline> out;
    for (ArcId a = 0; a < network.arc_count(); ++a) {
        ArcId const below = network.out(network.to(a));
        RiverSpline river{static_cast<std::int64_t>(a) + 1,
                          below == no_arc ? 0 : static_cast<std::int64_t>(below) + 1,
                          scene.orders.strahler[a],
                          {},
                          {},
                          {}};
        double begin = 0.0;
        for (ArcId const above : network.in(network.from(a))) {
            begin += ends[above];
        }
        begin = std::max(begin, cell_m * cell_m); // no river is without water
        double const end = std::max(ends[a], begin);
        std::vector<Vec2> const& line = network.arc(a).line;
        double const length = network.length_m(a);
        double along = 0.0;
        for (std::size_t i = 0; i < line.size(); ++i) {
            along += i > 0 ? distance(line[i - 1], line[i]) : 0.0;
            double const share = length > 0.0 ? std::min(along / length, 1.0) : 1.0;
            double const discharge = discharge_of_m2 * (begin + share * (end - begin));
            constexpr double width_of_root = 7.2;
            river.line.push_back({line[i].x, line[i].y, scene.network->arc_z[a][i]});
            river.discharge_m3s.push_back(discharge);
            river.width_m.push_back(width_of_root * std::sqrt(discharge));
        }
        out.push_back(std::move(river));
    }
    return out;
}

} // namespace thalweg::exports
