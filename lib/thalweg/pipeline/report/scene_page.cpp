// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/route.hpp>
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

/// What a scene shows of a terrain.
Terrain terrain_of(Scene const& scene, Run const& run) {
    Terrain terrain;
    terrain.grid = scene.dem->grid();
    terrain.surface.emplace();
    terrain.surface->dem = *scene.dem;
    terrain.drainage = flow::route(*scene.dem, run);
    if (scene.network) {
        terrain.network = *scene.network;
        terrain.orders = scene.orders;
    }
    return terrain;
}

/// What is measured of it.
Assessment assessment_of(Scene const& scene, Terrain const& terrain, Run const& run) {
    Assessment found;
    found.statistics = measure::statistics(*scene.dem, run);
    found.hypsometry = measure::hypsometry(*scene.dem, run);
    found.pits = terrain.drainage->pits;
    found.pit_volume_m3 = terrain.drainage->pit_volume_m3;
    if (scene.network) {
        StreamNetwork const& network = terrain.network.plan;
        if (lies_on(terrain.network, terrain.grid)) {
            found.areas = flow::areas_d8(network, *terrain.drainage, run);
        } else {
            found.areas.us_area_m2.assign(network.arc_count(), 0.0);
            found.areas.ds_area_m2.assign(network.arc_count(), 0.0);
            found.areas.node_m2.assign(network.node_count(), 0.0);
        }
        auto const topology = measure::check_topology(measure::as_file(terrain.network, terrain.orders), {}, run);
        found.checks = topology.checks;
        found.findings = topology.findings;
    }
    found.laws = laws_of_terrain(terrain, found.areas, found.statistics->cells, run);
    found.relief = relief_of_dem(*scene.dem, run);
    return found;
}

} // namespace

std::string scene_page(Scene const& scene, std::vector<std::string> const& notes, std::string const& command,
                       Run const& run) {
    if (!scene.dem) {
        throw BadInput("pipeline.scene_page: there is no DEM to show");
    }
    Made made;
    made.recipe.output.title = scene.title;
    made.terrain = terrain_of(scene, run);
    made.assessment = assessment_of(scene, made.terrain, run);
    double const relief = made.assessment.statistics->max.z - made.assessment.statistics->min.z;
    PageParams params;
    params.contour_interval_m = scene.contour_interval_m > 0.0 ? scene.contour_interval_m : round_interval(relief);
    params.command = command;
    params.notes = notes;
    return page(made, params, run);
}

} // namespace thalweg::pipeline
