// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/terrain.hpp>

#include <thalweg/flow/catchments/areas.hpp>
#include <thalweg/flow/catchments/reaches.hpp>
#include <thalweg/flow/conditioning/condition.hpp>
#include <thalweg/flow/routing/route.hpp>
#include <thalweg/flow/routing/route_dinf.hpp>
#include <thalweg/io/gdal/access.hpp>
#include <thalweg/measure/topology/topology.hpp>
#include <thalweg/pipeline/make/internal/around_rivers.hpp>
#include <thalweg/pipeline/make/internal/catchment_rows.hpp>
#include <thalweg/pipeline/make/internal/diary.hpp>
#include <thalweg/pipeline/make/internal/land.hpp>
#include <thalweg/pipeline/make/internal/land_in_equilibrium.hpp>
#include <thalweg/pipeline/make/internal/paste_patches.hpp>
#include <thalweg/pipeline/make/internal/river_claims.hpp>
#include <thalweg/pipeline/make/internal/rivers.hpp>
#include <thalweg/pipeline/recipe/internal/conversions.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_files.hpp>
#include <thalweg/pipeline/recipe/internal/unused_keys.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace thalweg::pipeline {

namespace {

/// Arcs that rise somewhere. Level ones are what the schema allows: lakes, tidal reaches.
std::int64_t uphill_arcs(RaisedNetwork const& network) {
    return std::count_if(network.arc_z.begin(), network.arc_z.end(), [](std::vector<double> const& z) {
        return std::adjacent_find(z.begin(), z.end(), std::less<>()) != z.end();
    });
}

std::int64_t valley_cells_moved(Valley const& valley, Raster<float> const& dem) {
    std::int64_t moved = 0;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        moved += !std::isnan(valley.z[i]) && !(valley.z[i] == dem[i]);
    }
    return moved;
}

/// Makes the land drain, as the recipe wants it.
void drain_land(Terrain& terrain, Diary& diary, Run const& run) {
    if (!terrain.surface || !terrain.recipe.surface) {
        return;
    }
    std::optional<flow::Conditioning>& method = terrain.recipe.surface->drain;
    method = method.value_or(terrain.recipe.network ? flow::Conditioning::carve : flow::Conditioning::none);
    if (*method == flow::Conditioning::none) {
        return;
    }
    Valley const none{Raster<float>(terrain.grid, std::numeric_limits<float>::quiet_NaN())};
    flow::ConditionedDem land = diary.stage("carve", [&] {
        return flow::condition(std::move(terrain.surface->dem), terrain.recipe.network ? terrain.valley : none,
                               {*method}, run);
    });
    terrain.surface->dem = std::move(land.dem);
    terrain.drained = {land.banks, land.depressions};
    diary.say(fmt::format("banks raised {:.0f} m3; depressions filled {:.0f} m3, cut {:.0f} m3", land.banks.raised_m3,
                          land.depressions.raised_m3, land.depressions.cut_m3));
}

Check none_of(char const* name, std::int64_t count) {
    return {name, static_cast<double>(count), 0.0, count == 0};
}

/// Of a land that was made to drain: whether it does, by its rivers where it honours them.
void check_drainage(Terrain& terrain, std::int64_t depressions) {
    if (!terrain.certificate) {
        terrain.checks.push_back(none_of("depressions", depressions));
        return;
    }
    std::vector<Check> const checks = terrain.certificate->checks();
    terrain.checks.insert(terrain.checks.end(), checks.begin(), checks.end());
}

void measure_land(Terrain& terrain, Diary& diary, Run const& run) {
    if (!terrain.surface) {
        terrain.areas = flow::areas_nearest(terrain.network.plan, terrain.grid, run);
        terrain.laws = laws_of_terrain(terrain, nullptr, run);
        return;
    }
    Raster<float> const& dem = terrain.surface->dem;
    terrain.statistics = diary.stage("measure", [&] { return measure::statistics(dem, run); });
    terrain.hypsometry = measure::hypsometry(dem, run);
    run.at(0.0, fmt::format("drain {} cells", terrain.grid.cells()).c_str());
    bool const sinks = terrain.recipe.network && terrain.recipe.network->inland == InlandEnds::sink;
    flow::FlowField const drainage = diary.stage("drain", [&] {
        StreamNetwork const& plan = terrain.network.plan;
        return flow::route(
            dem, sinks ? cells_of(inland_ends(plan, dem), plan, terrain.grid) : std::vector<std::int64_t>{}, run);
    });
    terrain.pits = drainage.pits;
    terrain.pit_volume_m3 = drainage.pit_volume_m3;
    if (terrain.recipe.network) {
        add_side_valleys(terrain, drainage, diary, run);
        terrain.areas = flow::areas_d8(terrain.network.plan, drainage, run);
        if (terrain.recipe.output.catchments) {
            terrain.catchments = diary.stage(
                "catchments", [&] { return flow::catchments(flow::reaches_of(terrain.network.plan), drainage, run); });
        }
        terrain.sinks = sinks ? inland_ends(terrain.network.plan, dem) : std::vector<NodeId>{};
        terrain.checks.push_back(none_of("valley_cells_moved", valley_cells_moved(terrain.valley, dem)));
        terrain.certificate = diary.stage("certify", [&] {
            measure::Claims claims;
            claims.ds_area_m2 = terrain.areas.ds_area_m2;
            claims.still = either(still_cells(measure::as_file(terrain.network, terrain.orders), terrain.grid),
                                  lake_cells(terrain.channels));
            claims.drawn = river_mask(terrain.valley);
            if (replaces_rivers(terrain.recipe)) {
                claims.honoured = claims.drawn;
            }
            return measure::certify(dem, drainage, flow::reaches_of(terrain.network.plan), claims, run);
        });
    }
    if (terrain.recipe.skeleton && terrain.recipe.skeleton->ridges != Ridges::none) {
        terrain.surface_ridges =
            diary.stage("ridges", [&] { return measure::extract_ridges(dem, terrain.ridges, run); });
        measure::Agreement const& within_a_cell = terrain.surface_ridges->extracted[1];
        diary.say(
            fmt::format("{:.0f} % of those asked for are ridges of the surface, {:.0f} % of its own are asked for",
                        100.0 * within_a_cell.recall, 100.0 * within_a_cell.precision));
    }
    if (terrain.drained) {
        check_drainage(terrain, static_cast<std::int64_t>(drainage.depressions.size()));
    }
    if (terrain.recipe.output.accumulation) {
        terrain.water_areas = diary.stage("areas", [&] {
            return WaterAreas{areas_m2(drainage), areas_m2(flow::route_dinf(dem, drainage, run).area_cells)};
        });
    }
    terrain.laws = diary.stage("laws", [&] { return laws_of_terrain(terrain, &drainage, run); });
    terrain.relief = diary.stage("relief", [&] { return relief_of_terrain(terrain, drainage, run); });
}

void check_rivers(Terrain& terrain, Diary& diary, Run const& run) {
    measure::TopologyReport topology = diary.stage(
        "check", [&] { return measure::check_topology(measure::as_file(terrain.network, terrain.orders), {}, run); });
    terrain.checks.insert(terrain.checks.begin(), none_of("uphill_arcs", uphill_arcs(terrain.network)));
    terrain.checks.insert(terrain.checks.end(), topology.checks.begin(), topology.checks.end());
    terrain.findings.insert(terrain.findings.end(), topology.findings.begin(), topology.findings.end());
    if (terrain.drained && terrain.certificate) {
        std::vector<Check> const checks = terrain.certificate->checks();
        if (!std::all_of(checks.begin(), checks.end(), [](Check const& c) { return c.ok; })) { // else nobody looks
            std::vector<Finding> const& more = terrain.certificate->findings;
            terrain.findings.insert(terrain.findings.end(), more.begin(), more.end());
        }
    }
}

} // namespace

bool Terrain::passed() const {
    return std::all_of(checks.begin(), checks.end(), [](Check const& c) { return c.ok; });
}

Terrain make_terrain(Recipe const& wanted, Run const& run, Keep const& keep) {
    check_recipe(wanted);
    io::RecipeFiles const confined;
    Terrain terrain;
    terrain.recipe = wanted;
    Diary diary(run, terrain);
    FeaturePoints points;
    if (wanted.network) {
        make_rivers(terrain, diary, run);
        refuse_unused_keys(terrain.recipe); // now that the rivers' heights are known
        if (wanted.skeleton) {
            points = given_points(terrain.recipe, run);
            require_on_grid(points, terrain.grid, terrain.recipe.skeleton->points);
        }
    } else {
        points = given_points(terrain.recipe, run);
        take_frame(terrain, frame_land(points, terrain.recipe.grid));
        if (terrain.recipe.skeleton) {
            require_on_grid(points, terrain.grid, terrain.recipe.skeleton->points);
        }
        report_conversions(terrain, run);
    }
    check_detail(terrain.recipe, terrain.grid.width, terrain.grid.height);
    if (keep && wanted.network) {
        keep("valley", terrain.valley.z);
    }

    if (!wanted.network) {
        make_land(terrain, points, diary, run);
    } else if (wanted.surface) {
        draw_around_rivers(terrain, points, diary, run);
    }
    paste_patches(terrain, diary, run);
    drain_land(terrain, diary, run);
    if (keep && terrain.surface) {
        keep("surface", terrain.surface->dem);
    }
    measure_land(terrain, diary, run);
    if (wanted.network) {
        check_rivers(terrain, diary, run);
    }
    return terrain;
}

} // namespace thalweg::pipeline
