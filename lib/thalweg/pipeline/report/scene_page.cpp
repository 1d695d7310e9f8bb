// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/report/internal/scene_page.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/catchments/areas.hpp>
#include <thalweg/flow/routing/route.hpp>
#include <thalweg/measure/topology/topology.hpp>
#include <thalweg/pipeline/report/internal/page.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace thalweg::pipeline {

namespace {

/// Whether every vertex of the network lies on the DEM's grid, as areas by its drainage need.
bool lies_on(ElevatedNetwork const& network, Grid const& grid) {
    for (ArcId arc = 0; arc < network.plan.arc_count(); ++arc) {
        auto const& line = network.plan.arc(arc).line;
        if (!std::all_of(line.begin(), line.end(), [&](Vec2 p) { return grid.contains(grid.cell_of(p)); })) {
            return false;
        }
    }
    return true;
}

} // namespace

std::string scene_page(Scene const& scene, std::vector<std::string> const& notes, std::string const& command,
                       Run const& run) {
    if (!scene.dem) {
        throw BadInput("pipeline.scene_page: there is no DEM to show");
    }
    DrawnTerrain drawn;
    drawn.recipe.output.title = scene.title;
    drawn.grid = scene.dem->grid();
    drawn.surface.emplace();
    drawn.surface->dem = *scene.dem;
    Assessment found;
    found.statistics = measure::statistics(*scene.dem, run);
    found.hypsometry = measure::hypsometry(*scene.dem, run);
    flow::FlowField const drainage = flow::route(*scene.dem, run);
    found.pits = drainage.pits;
    found.pit_volume_m3 = drainage.pit_volume_m3;
    if (scene.network) {
        drawn.network = *scene.network;
        drawn.orders = scene.orders;
        std::size_t const arcs = drawn.network.plan.arc_count();
        if (lies_on(drawn.network, drawn.grid)) {
            found.areas = flow::areas_d8(drawn.network.plan, drainage, run);
        } else {
            found.areas.us_area_m2.assign(arcs, 0.0);
            found.areas.ds_area_m2.assign(arcs, 0.0);
            found.areas.node_m2.assign(drawn.network.plan.node_count(), 0.0);
        }
        auto const topology = measure::check_topology(measure::as_file(drawn.network, drawn.orders), {}, run);
        found.checks = topology.checks;
        found.findings = topology.findings;
    }
    found.laws = laws_of_terrain(drawn, found.areas, found.statistics->cells, &drainage, run);
    found.relief = relief_of_dem(*scene.dem, run);
    Terrain const terrain = together({}, std::move(drawn), std::move(found));
    double const relief = terrain.statistics->max.z - terrain.statistics->min.z;
    PageParams params;
    params.contour_interval_m = scene.contour_interval_m > 0.0 ? scene.contour_interval_m : round_interval(relief);
    params.command = command;
    params.notes = notes;
    return page(terrain, params, run);
}

} // namespace thalweg::pipeline
