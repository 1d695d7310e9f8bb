// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/assess.hpp>

#include <thalweg/flow/catchments/areas.hpp>
#include <thalweg/flow/catchments/reaches.hpp>
#include <thalweg/flow/flow_field.hpp>
#include <thalweg/flow/routing/route_dinf.hpp>
#include <thalweg/measure/topology/topology.hpp>
#include <thalweg/pipeline/make/internal/catchment_rows.hpp>
#include <thalweg/pipeline/make/internal/river_claims.hpp>
#include <thalweg/pipeline/plan/internal/append.hpp>
#include <thalweg/pipeline/plan/internal/diary.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_asks.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace thalweg::pipeline {

namespace {

/// Arcs that rise somewhere. Level ones are what the schema allows: lakes, tidal reaches.
std::int64_t uphill_arcs(ElevatedNetwork const& network) {
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

Check none_of(char const* name, std::int64_t count) {
    return {name, static_cast<double>(count), 0.0, count == 0};
}

/// What the rivers claim of the surface.
measure::Claims claims_of(DrawnTerrain const& drawn, flow::ContributingAreas const& areas) {
    measure::Claims claims;
    claims.ds_area_m2 = areas.ds_area_m2;
    claims.still =
        either(still_cells(measure::as_file(drawn.network, drawn.orders), drawn.grid), lake_cells(drawn.channels));
    claims.drawn = river_mask(drawn.valley);
    if (replaces_rivers(drawn.recipe)) {
        claims.honoured = claims.drawn;
    }
    return claims;
}

/// What is measured of rivers on their surface.
Assessment with_rivers(Assessment found, DrawnTerrain const& drawn, flow::FlowField const& drainage, Diary& diary,
                       Run const& run) {
    StreamNetwork const& plan = drawn.network.plan;
    Raster<float> const& dem = drawn.surface->dem;
    found.areas = flow::areas_d8(plan, drainage, run);
    if (drawn.recipe.output.catchments) {
        found.catchments =
            diary.stage("catchments", [&] { return flow::catchments(flow::reaches_of(plan), drainage, run); });
    }
    if (drawn.recipe.network->inland == InlandEnds::sink) {
        found.sinks = inland_ends(plan, dem);
    }
    found.checks.push_back(none_of("valley_cells_moved", valley_cells_moved(drawn.valley, dem)));
    found.certificate = diary.stage("certify", [&] {
        return measure::certify(dem, drainage, flow::reaches_of(plan), claims_of(drawn, found.areas), run);
    });
    return found;
}

/// Of a surface that was made to drain: whether it does, by its rivers where it honours them.
std::vector<Check> drainage_checks(Assessment const& found, flow::FlowField const& drainage) {
    return found.certificate
               ? found.certificate->checks()
               : std::vector<Check>{none_of("depressions", static_cast<std::int64_t>(drainage.depressions.size()))};
}

/// What is measured of a surface, with the rivers on it.
Assessment of_surface(DrawnTerrain const& drawn, flow::FlowField const& drainage, Diary& diary, Run const& run) {
    Raster<float> const& dem = drawn.surface->dem;
    Assessment found;
    found.statistics = diary.stage("measure", [&] { return measure::statistics(dem, run); });
    found.hypsometry = measure::hypsometry(dem, run);
    found.pits = drainage.pits;
    found.pit_volume_m3 = drainage.pit_volume_m3;
    if (drawn.recipe.network) {
        found = with_rivers(std::move(found), drawn, drainage, diary, run);
    }
    if (drawn.recipe.skeleton && drawn.recipe.skeleton->ridges != Ridges::none) {
        found.surface_ridges = diary.stage("ridges", [&] { return measure::extract_ridges(dem, drawn.ridges, run); });
        measure::Agreement const& within_a_cell = found.surface_ridges->extracted[1];
        diary.say(
            fmt::format("{:.0f} % of those asked for are ridges of the surface, {:.0f} % of its own are asked for",
                        100.0 * within_a_cell.recall, 100.0 * within_a_cell.precision));
    }
    if (drawn.drained) {
        append(found.checks, drainage_checks(found, drainage));
    }
    if (drawn.recipe.output.accumulation) {
        found.water_areas = diary.stage("areas", [&] {
            return WaterAreas{areas_m2(drainage), areas_m2(flow::route_dinf(dem, drainage, run).area_cells)};
        });
    }
    found.laws = diary.stage(
        "laws", [&] { return laws_of_terrain(drawn, found.areas, found.statistics->cells, &drainage, run); });
    found.relief = diary.stage("relief", [&] { return relief_of_terrain(drawn, *found.statistics, drainage, run); });
    return found;
}

/// Findings of a certificate that somebody looks at: of one that failed.
std::vector<Finding> findings_of(std::optional<measure::Certificate> const& certificate) {
    if (!certificate) {
        return {};
    }
    std::vector<Check> const checks = certificate->checks();
    bool const ok = std::all_of(checks.begin(), checks.end(), [](Check const& c) { return c.ok; });
    return ok ? std::vector<Finding>{} : certificate->findings;
}

} // namespace

Assessment assess(DrawnTerrain const& drawn, std::optional<flow::FlowField> const& drainage, Run const& run) {
    Diary diary(run);
    Assessment found;
    if (drawn.surface) {
        found = of_surface(drawn, *drainage, diary, run);
    } else {
        found.areas = flow::areas_nearest(drawn.network.plan, drawn.grid, run);
        found.laws = laws_of_terrain(drawn, found.areas, drawn.grid.cells(), nullptr, run);
    }
    std::vector<Check> checks = drawn.checks;
    append(checks, std::move(found.checks));
    found.findings = drawn.findings;
    if (drawn.recipe.network) {
        measure::TopologyReport topology = diary.stage(
            "check", [&] { return measure::check_topology(measure::as_file(drawn.network, drawn.orders), {}, run); });
        checks.insert(checks.begin(), none_of("uphill_arcs", uphill_arcs(drawn.network)));
        append(checks, std::move(topology.checks));
        append(found.findings, std::move(topology.findings));
        if (drawn.drained) {
            append(found.findings, findings_of(found.certificate));
        }
    }
    found.checks = std::move(checks);
    found.timings_s = diary.take();
    return found;
}

} // namespace thalweg::pipeline
