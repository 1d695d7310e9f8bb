// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <thalweg/measure/topology/topology.hpp>
#include <thalweg/pipeline/make/internal/file_values.hpp>
#include <thalweg/pipeline/make/internal/river_claims.hpp>
#include <thalweg/pipeline/plan/internal/plan.hpp>
#include <thalweg/pipeline/recipe/internal/check_recipe.hpp>

namespace thalweg::pipeline {

namespace {

/// Counts arcs that rise somewhere. The schema allows level ones: lakes, tidal reaches.
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

/// The rivers' claims on the surface.
measure::Claims claims_of(Plan const& plan, Terrain const& terrain, flow::ContributingAreas const& areas) {
    measure::Claims claims;
    claims.ds_area_m2 = areas.ds_area_m2;
    claims.still = either(still_cells(measure::as_file(terrain.network, terrain.orders), terrain.grid),
                          lake_cells(terrain.channels));
    claims.drawn = river_mask(terrain.valley);
    if (replaces_rivers(plan.recipe)) {
        claims.honoured = claims.drawn;
    }
    return claims;
}

/// Adds measures of rivers on their surface.
Assessment with_rivers(Plan const& plan, Assessment found, Terrain const& terrain, Diary& diary, Run const& run) {
    flow::FlowField const& drainage = *terrain.drainage;
    StreamNetwork const& network = terrain.network.plan;
    Raster<float> const& dem = terrain.surface->dem;
    found.areas = flow::areas_d8(network, drainage, run);
    if (plan.recipe.output.catchments) {
        found.catchments =
            diary.stage("catchments", [&] { return flow::catchments(flow::reaches_of(network), drainage, run); });
    }
    if (plan.recipe.network->inland == InlandEnds::sink) {
        found.sinks = inland_ends(network, dem);
    }
    found.checks.push_back(none_of("valley_cells_moved", valley_cells_moved(terrain.valley, dem)));
    found.certificate = diary.stage("certify", [&] {
        return measure::certify(dem, drainage, flow::reaches_of(network), claims_of(plan, terrain, found.areas), run);
    });
    return found;
}

/// Checks of a conditioned surface: whether it drains, along its rivers where it honours them.
std::vector<Check> drainage_checks(Assessment const& found, flow::FlowField const& drainage) {
    return found.certificate
               ? found.certificate->checks()
               : std::vector<Check>{none_of("depressions", static_cast<std::int64_t>(drainage.depressions.size()))};
}

/// Warns if the hillshade of terrain in equilibrium would look unnatural: its texture is outside the range of the
/// reference DEMs.
void warn_of_texture(Plan const& plan, Terrain const& terrain, TerrainRelief const& relief, Run const& run) {
    constexpr std::int64_t least_cells = 250'000; // with fewer, randomness dominates
    if (!terrain.equilibrium || terrain.grid.cells() < least_cells) {
        return;
    }
    std::string const outside = unlike_land(relief_rows(relief), plan.recipe.network->source == Source::lines);
    if (!outside.empty()) {
        run.say("warning: measures of the relief lie outside those of the reference DEMs: " + outside +
                ". docs/relief_measures.md says what they mean.");
    }
}

/// Measures a surface with its rivers.
Assessment of_surface(Plan const& plan, Terrain const& terrain, Diary& diary, Run const& run) {
    flow::FlowField const& drainage = *terrain.drainage;
    Raster<float> const& dem = terrain.surface->dem;
    Assessment found;
    found.statistics = diary.stage("measure", [&] { return measure::statistics(dem, run); });
    found.hypsometry = measure::hypsometry(dem, run);
    found.pits = drainage.pits;
    found.pit_volume_m3 = drainage.pit_volume_m3;
    if (plan.recipe.network) {
        found = with_rivers(plan, std::move(found), terrain, diary, run);
    }
    if (has_ridges(plan.recipe)) {
        found.surface_ridges = diary.stage("ridges", [&] { return measure::extract_ridges(dem, terrain.ridges, run); });
        measure::Agreement const& within_a_cell = found.surface_ridges->extracted[1];
        diary.say(
            fmt::format("{:.0f} % of those asked for are ridges of the surface, {:.0f} % of its own are asked for",
                        100.0 * within_a_cell.recall, 100.0 * within_a_cell.precision));
    }
    if (terrain.drained) {
        append(found.checks, drainage_checks(found, drainage));
    }
    if (plan.recipe.output.accumulation) {
        found.water_areas = diary.stage("areas", [&] {
            return WaterAreas{areas_m2(drainage), areas_m2(flow::route_dinf(dem, drainage, run).area_cells)};
        });
    }
    found.laws =
        diary.stage("laws", [&] { return laws_of_terrain(terrain, found.areas, found.statistics->cells, run); });
    found.relief = diary.stage("relief", [&] { return relief_of_terrain(plan, terrain, *found.statistics, run); });
    warn_of_texture(plan, terrain, *found.relief, run);
    return found;
}

/// Returns the findings only if the certificate failed.
std::vector<Finding> findings_of(std::optional<measure::Certificate> const& certificate) {
    if (!certificate) {
        return {};
    }
    std::vector<Check> const checks = certificate->checks();
    bool const ok = std::all_of(checks.begin(), checks.end(), [](Check const& c) { return c.ok; });
    return ok ? std::vector<Finding>{} : certificate->findings;
}

/// Measures rivers without a surface.
Assessment of_rivers_alone(Terrain const& terrain, Run const& run) {
    Assessment found;
    found.areas = flow::areas_nearest(terrain.network.plan, terrain.grid, run);
    found.laws = laws_of_terrain(terrain, found.areas, terrain.grid.cells(), run);
    return found;
}

/// Puts the checks and findings made while drawing the terrain first.
Assessment with_requests(Terrain const& terrain, Assessment found) {
    std::vector<Check> checks = terrain.checks;
    append(checks, std::move(found.checks));
    found.checks = std::move(checks);
    found.findings = terrain.findings;
    return found;
}

/// Adds topology checks: arcs descend and connect.
Assessment with_topology(Plan const& plan, Terrain const& terrain, Assessment found, Diary& diary, Run const& run) {
    if (!plan.recipe.network) {
        return found;
    }
    measure::TopologyReport topology = diary.stage(
        "check", [&] { return measure::check_topology(measure::as_file(terrain.network, terrain.orders), {}, run); });
    found.checks.insert(found.checks.begin(), none_of("uphill_arcs", uphill_arcs(terrain.network)));
    append(found.checks, std::move(topology.checks));
    append(found.findings, std::move(topology.findings));
    if (terrain.drained) {
        append(found.findings, findings_of(found.certificate));
    }
    return found;
}

/// Adds the account of the input's length; warns if more than 1 % of it is missing.
Assessment with_given_length(Plan const& plan, Rivers const& rivers, Terrain const& terrain, Assessment found,
                             Run const& run) {
    constexpr double worth_a_word = 0.99;
    found.given = given_length(plan, rivers, terrain);
    if (!found.given) {
        return found;
    }
    double const share = found.given->share();
    double const least = plan.recipe.network->lines.keep;
    found.checks.push_back({"given_length", share, least, share >= least, Bound::at_least});
    run.tell("given", line_of(*found.given));
    if (share < worth_a_word) {
        double const gone_m = found.given->given_m() - found.given->kept_m;
        double const short_m = found.given->left_out(LeftOut::too_short);
        run.say(fmt::format("warning: {:.1f} of the {:.1f} km of rivers in {} are not in the network, {}. Layer "
                            "secondary of network.gpkg has them.{}",
                            gone_m / 1000.0, found.given->given_m() / 1000.0, plan.lines.name,
                            short_m > 0.5 * gone_m ? "most of them too short"
                                                   : "most of them cut at heads that lie beside other rivers",
                            short_m < gone_m ? fmt::format(" Finer cells keep them apart: --set grid.cell={}.",
                                                           terrain.grid.cell_m / 2.0)
                                             : ""));
    }
    return found;
}

/// Compares the input's heights with the DEM's; warns of misses.
Assessment with_given_heights(Plan const& plan, Rivers const& rivers, Terrain const& terrain, Assessment found,
                              Run const& run) {
    found.given_heights = given_heights(plan, rivers, terrain);
    if (found.given_heights && found.given_heights->missed > 0) {
        GivenHeights const& given = *found.given_heights;
        run.say(fmt::format(
            "warning: at {} of the {} vertices with heights in {} dem.tif is off by more than {:g} m: by "
            "{:.3g} m on average, by {:.3g} m at most.",
            given.missed, given.vertices, plan.lines.name, given.tolerance_m, given.mean_m, given.largest_m));
    }
    return found;
}

/// Compares the input's drainage areas with the terrain's.
Assessment with_given_areas(Plan const& plan, Rivers const& rivers, Terrain const& terrain, Assessment found,
                            Run const& run) {
    if (terrain.drainage && found.given) {
        found.given_areas = given_areas(plan, rivers, terrain, found.areas.ds_area_m2);
    }
    if (found.given_areas) {
        run.tell("areas", line_of(*found.given_areas));
    }
    return found;
}

} // namespace

bool Assessment::passed() const {
    return std::all_of(checks.begin(), checks.end(), [](Check const& c) { return c.ok; });
}

Assessment assess(Plan const& plan, Rivers const& rivers, Terrain const& terrain, Run const& run) {
    Diary diary(run);
    Assessment found = terrain.surface ? of_surface(plan, terrain, diary, run) : of_rivers_alone(terrain, run);
    found = with_requests(terrain, std::move(found));
    found = with_topology(plan, terrain, std::move(found), diary, run);
    found = with_given_length(plan, rivers, terrain, std::move(found), run);
    found = with_given_heights(plan, rivers, terrain, std::move(found), run);
    found = with_given_areas(plan, rivers, terrain, std::move(found), run);
    found.timings_s = diary.take();
    return found;
}

} // namespace thalweg::pipeline
