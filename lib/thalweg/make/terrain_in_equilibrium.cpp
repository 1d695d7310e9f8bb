// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <fmt/format.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/make/internal/features.hpp>
#include <thalweg/make/internal/lakes.hpp>
#include <thalweg/make/internal/planform.hpp>
#include <thalweg/make/internal/terrain.hpp>
#include <thalweg/measure/relief/slopes.hpp>
#include <thalweg/measure/texture/texture.hpp>
#include <thalweg/network/channels/channels.hpp>
#include <thalweg/network/channels/side_valleys.hpp>
#include <thalweg/network/elevation/known_heights.hpp>
#include <thalweg/network/vectorise/prune.hpp>
#include <thalweg/network/vectorise/rasterise.hpp>
#include <thalweg/recipe/check_recipe.hpp>
#include <thalweg/recipe/read_inputs.hpp>
#include <thalweg/recipe/recipe_files.hpp>
#include <thalweg/recipe/stages.hpp>
#include <thalweg/surface/equilibrium/rebuild.hpp>
#include <thalweg/surface/uplift/uplift_pattern.hpp>

namespace thalweg::make {
namespace {

/// Cells that are land in both masks, of which either may be empty, and river cells.
Mask land_of(Mask one, Mask const& other, Channels const& channels) {
    if (one.values().empty()) {
        one = other;
    } else if (!other.values().empty()) {
        for (std::int64_t i = 0; i < one.cells(); ++i) {
            one[i] = one[i] != 0 && other[i] != 0 ? 1 : 0;
        }
    }
    if (!one.values().empty()) {
        for (std::int64_t const cell : channels.cell) {
            one[cell] = 1;
        }
    }
    return one;
}

/// Uplift from a file, which may be empty, times that of the requested pattern.
Raster<float> with_pattern(Raster<float> of_file, recipe::Recipe const& recipe, Grid const& grid, Run const& run) {
    recipe::EquilibriumRecipe const& wanted = recipe.surface->equilibrium;
    if (!wanted.uplift_pattern) {
        return of_file;
    }
    Raster<float> uplift =
        surface::uplift_pattern(grid,
                                {.pattern = *wanted.uplift_pattern,
                                 .contrast = wanted.uplift_contrast,
                                 .wave_m = wanted.uplift_wave_m,
                                 .strike_deg = wanted.strike_deg.value_or(surface::random_strike_deg(recipe.seed)),
                                 .seed = recipe.seed},
                                run);
    for (std::int64_t i = 0; i < of_file.cells(); ++i) {
        uplift[i] *= of_file[i];
    }
    return uplift;
}

// Land, uplift and erodibility of terrain in equilibrium: from the recipe's files and its pattern of uplift.
surface::EquilibriumFields equilibrium_fields(recipe::Plan const& plan, Planform const& planform,
                                              Channels const& channels, Run const& run) {
    recipe::Recipe const& recipe = plan.recipe;
    Grid const& grid = planform.grid;
    recipe::SurfaceRecipe const& wanted = *recipe.surface;
    surface::EquilibriumFields fields;
    fields.land = land_of(recipe::read_mask_of_land(recipe::file_in(recipe, recipe.surface->mask), grid, run),
                          planform.land, channels);
    fields.uplift = with_pattern(
        recipe::read_field(recipe::file_in(recipe, wanted.equilibrium.uplift), grid, "surface.uplift", run), recipe,
        grid, run);
    fields.erodibility =
        recipe::read_field(recipe::file_in(recipe, wanted.equilibrium.erodibility), grid, "surface.erodibility", run);
    fields.features = feature_cells(plan, grid);
    return fields;
}

constexpr float none = std::numeric_limits<float>::quiet_NaN();

surface::RiverHeights use_of(recipe::Heights heights) {
    return heights == recipe::Heights::graded ? surface::RiverHeights::graded
           : heights == recipe::Heights::soft ? surface::RiverHeights::soft
                                              : surface::RiverHeights::fixed;
}

bool has_sea(Mask const& land) {
    return std::any_of(land.values().begin(), land.values().end(), [](std::uint8_t is_land) { return is_land == 0; });
}

/// Whether the gaps of a DEM are the sea: rivers that end there do so near height 0.
bool are_sea(Mask const& land, Channels const& channels) {
    constexpr float most_m = 10.0F;
    constexpr double most_of_them = 0.9;
    constexpr std::int64_t near = 2;
    Grid const& grid = land.grid();
    double ends = 0.0;
    double low = 0.0;
    for (std::size_t n = 0; n < channels.cell.size(); ++n) {
        Cell const c = grid.at(channels.cell[n]);
        bool beside = false;
        for (std::int64_t k = 0; channels.receiver[n] < 0 && k < (2 * near + 1) * (2 * near + 1); ++k) {
            Cell const other{c.col + k % (2 * near + 1) - near, c.row + k / (2 * near + 1) - near};
            beside = beside || (grid.contains(other) && land[other] == 0);
        }
        ends += beside ? 1.0 : 0.0;
        low += beside && std::fabs(channels.z[n]) <= most_m ? 1.0 : 0.0;
    }
    return ends > 0.0 && low >= most_of_them * ends;
}

surface::Edge edge_of(recipe::Plan const& plan, Planform const& planform, Mask const& land, Channels const& channels) {
    if (plan.recipe.surface->equilibrium.edge) {
        return *plan.recipe.surface->equilibrium.edge;
    }
    if (plan.land.cells() > 0 && !recipe::has_coastlines(plan)) {
        return are_sea(plan.land, channels) ? surface::Edge::coast : surface::Edge::closed;
    }
    bool const by_coastlines = plan.recipe.network->source == recipe::Source::lines && planform.land.cells() > 0;
    return by_coastlines ? surface::Edge::mainland : has_sea(land) ? surface::Edge::coast : surface::Edge::open;
}

/// The plan's parameters of the terrain, for rivers with this method of heights.
surface::EquilibriumParams params_of(recipe::Plan const& plan, recipe::Heights heights, surface::Edge edge) {
    recipe::Recipe const& recipe = plan.recipe;
    recipe::EquilibriumRecipe const& wanted = recipe.surface->equilibrium;
    constexpr double half_width_km = 0.2125; // of valley floors where 1 km² drains, for a floor_width of 1
    double const relief_m = recipe.surface->dilate.relief_m;
    surface::EquilibriumParams params;
    params.theta = recipe.network->concavity;
    params.heights = use_of(heights);
    params.bring_to_target = wanted.mean_slope_deg || plan.like || relief_m > 0.0;
    if (relief_m > 0.0) {
        params.relief_m = relief_m;
    } else if (params.bring_to_target) {
        params.mean_slope_deg = wanted.mean_slope_deg ? *wanted.mean_slope_deg : plan.like->mean_slope_deg;
    } else if (recipe.network->source == recipe::Source::lines) { // given heights have their own slope
        params.mean_slope_deg = recipe::usual_slope_deg(recipe.grid.cell_m);
    }
    params.hillslope_m = wanted.hillslope_m > 0.0 ? wanted.hillslope_m : recipe.grid.cell_m;
    params.debris_area_m2 = wanted.debris_area_km2 * 1e6;
    params.floor_width_km = half_width_km * wanted.floor_width;
    params.roughness = wanted.roughness;
    params.longest_wave_m = wanted.longest_wave_m;
    params.grain = wanted.grain;
    params.strike_deg = wanted.strike_deg;
    bool const by_file = recipe.network->source == recipe::Source::lines; // the file includes all rivers that enter
    params.region = wanted.region.value_or(params.region);
    params.inflow = !by_file;
    params.heads = by_file ? surface::Heads::kept : surface::Heads::cut;
    params.edge = edge;
    params.seed = recipe.seed;
    return params;
}

/// The prescribed heights of channels: all that the rivers have, or those of sources and ends.
std::vector<float> asked_heights(ElevatedNetwork const& rivers, Channels const& channels, recipe::Heights heights) {
    std::vector<float> z = network::channel_heights(rivers, channels);
    if (heights == recipe::Heights::ends) {
        std::vector<std::uint8_t> has_donor(z.size());
        for (std::int64_t const r : channels.receiver) {
            if (r >= 0) {
                has_donor[static_cast<std::size_t>(r)] = 1;
            }
        }
        for (std::size_t c = 0; c < z.size(); ++c) {
            z[c] = has_donor[c] != 0 && channels.receiver[c] >= 0 ? none : z[c];
        }
    }
    return z;
}

/// Checks the relief or mean slope that the recipe asks for, with a warning where it is missed.
/// by_levels: lakes have levels.
std::vector<Check> target_checks(surface::EquilibriumTerrain const& surface, surface::EquilibriumParams const& params,
                                 bool by_levels, StageLog& stage_log) {
    constexpr double allowed = 0.05;
    bool const given = params.heights != surface::RiverHeights::graded;
    if ((given || by_levels) && !params.bring_to_target) {
        return {};
    }
    double const error = std::fabs(surface.target_share - 1.0);
    if (error > allowed) {
        double const asked = params.relief_m ? *params.relief_m : params.mean_slope_deg;
        char const* const unit = params.relief_m ? "m" : "degrees";
        char const* const name = params.relief_m ? "relief" : "mean_slope";
        stage_log.find({.kind = "target_missed",
                        .amount = surface.target_share * asked,
                        .text = fmt::format("surface.{} = {:.6g} {} cannot be reached with the {}: it is {:.4g} {}",
                                            name, asked, unit, given ? "heights of the rivers" : "levels of the lakes",
                                            surface.target_share * asked, unit),
                        .key = fmt::format("surface.{}", name),
                        .numbers = {{"asked", asked, params.relief_m ? "m" : "deg"}}});
    }
    return {{params.relief_m ? "relief_error" : "mean_slope_error", error, allowed, error <= allowed}};
}

double most_walled(Channels const& channels) {
    return 0.01 * static_cast<double>(channels.cell.size());
}

bool too_walled(surface::EquilibriumTerrain const& land, Channels const& channels) {
    return static_cast<double>(land.walled.size()) > most_walled(channels);
}

/// Checks how many river cells only walls hold up. remedy: for the warning.
Check wall_check(surface::EquilibriumTerrain const& surface, Channels const& channels, char const* remedy,
                 StageLog& stage_log) {
    constexpr std::size_t listed = 1000;
    bool const ok = !too_walled(surface, channels);
    if (!ok) {
        stage_log.find({.kind = "walled_rivers",
                        .amount = static_cast<double>(surface.walled.size()),
                        .text = fmt::format("{} of {} river cells stand on walls above the terrain",
                                            surface.walled.size(), channels.cell.size()),
                        .remedy = remedy,
                        .key = "network.heights",
                        .numbers = {{"river_cells", static_cast<double>(channels.cell.size()), "cells"}}});
    }
    Grid const& grid = surface.dem.grid();
    for (std::size_t i = 0; i < std::min(listed, surface.walled.size()); ++i) {
        std::int64_t const cell = channels.cell[static_cast<std::size_t>(surface.walled[i])];
        Vec2 const at = grid.centre(grid.at(cell));
        stage_log.find({"walled_cell", 0, at, static_cast<double>(surface.dem[cell]),
                        fmt::format("the river at ({:.1f}, {:.1f}) stands {:.5g} m high, on a wall: the land around "
                                    "is lower",
                                    at.x, at.y, surface.dem[cell])});
    }
    return {"walled_cells", static_cast<double>(surface.walled.size()), std::floor(most_walled(channels)), ok};
}

/// Checks that rivers lie in valleys of rebuilt terrain, with a warning where they stand above much of it.
Check valley_check(Raster<float> const& dem, Channels const& channels, bool has_sea, StageLog& stage_log,
                   Run const& run) {
    constexpr double most_sunken = 0.1;
    double const share = measure::sunken_share(dem, channels.cell, {.has_sea = has_sea}, run);
    if (share > most_sunken) {
        stage_log.find({.kind = "land_below_rivers",
                        .amount = share,
                        .text = fmt::format("{:.0f} % of the land lies lower than the river nearest to it: the rivers "
                                            "stand on walls. Their slopes tell too little of the land's",
                                            100.0 * share),
                        .remedy = "Give it, with --set surface.mean_slope=20 or --like DEM",
                        .key = "surface.mean_slope"});
    }
    return {"land_below_rivers", share, most_sunken, share <= most_sunken};
}

/// A terrain in equilibrium, and its solver's parameters.
struct Solved {
    surface::EquilibriumTerrain land;
    surface::EquilibriumParams params;
    std::optional<RebuildStatistics> rebuilt = {};
    std::optional<LikeStatistics> like = {};
    std::vector<Finding> findings = {};
};

/// Whether the terrain is rebuilt from rivers with heights of a file.
bool rebuilds(recipe::Plan const& plan) {
    return plan.recipe.network->heights == recipe::Heights::file;
}

/// Keys that describe terrain in equilibrium keep their meaning relative to their defaults.
surface::RebuildParams rebuild_params_of(recipe::EquilibriumRecipe const& wanted,
                                         surface::EquilibriumParams const& given) {
    surface::EquilibriumParams const usual;
    surface::RebuildParams params;
    if (given.relief_m) {
        params.relief_m = given.relief_m;
    } else if (given.bring_to_target) {
        params.mean_slope_deg = given.mean_slope_deg;
    }
    params.theta = std::clamp(params.theta * given.theta / usual.theta, 0.1, 0.9);
    params.hillslope_m = wanted.hillslope_m > 0.0 ? wanted.hillslope_m : params.hillslope_m;
    params.debris_area_m2 *= given.debris_area_m2 / usual.debris_area_m2;
    params.floor_width_km = given.floor_width_km;
    params.roughness = std::min(1.0, params.roughness * given.roughness / usual.roughness);
    params.longest_wave_m *= given.longest_wave_m / usual.longest_wave_m;
    params.edge = given.edge;
    params.seed = given.seed;
    return params;
}

/// Warns where rivers tell little of how steep the land between them is, and nothing else does.
std::vector<Finding> doubts_of(surface::RiverSurvey const& survey) {
    constexpr double least_km2 = 0.1;
    constexpr double least_deg = 5.0;
    constexpr double of_smooth = 0.8; // mean slope of smooth terrain relative to that of the terrain
    char const* const remedy = "Give it, with --like DEM or --set surface.mean_slope=";
    double const slope_deg = survey.mean_slope_deg / of_smooth;
    if (survey.source_km2 > 0.0 && survey.source_km2 < least_km2) {
        return {{.kind = "rills",
                 .amount = survey.source_km2,
                 .text = fmt::format("half of the rivers begin where less than {:.2g} km² drain: they are rills or "
                                     "gullies, whose slope tells little of the land's, taken for {:.0f} degrees",
                                     survey.source_km2, slope_deg),
                 .remedy = fmt::format("{}{:.0f}", remedy, 20.0),
                 .key = "surface.mean_slope",
                 .numbers = {{"mean_slope", slope_deg, "deg"}}}};
    }
    if (slope_deg < least_deg) {
        return {{.kind = "gentle_land",
                 .amount = slope_deg,
                 .text = fmt::format("by its rivers the land is gentle, {:.1f} degrees on average; below {:g} degrees "
                                     "they tell little of its slope",
                                     slope_deg, least_deg),
                 .remedy = fmt::format("{}{:.1f}", remedy, 0.5 * slope_deg),
                 .key = "surface.mean_slope"}};
    }
    return {};
}

Solved rebuild_terrain(recipe::Plan const& plan, Channels const& channels, surface::EquilibriumFields const& fields,
                       surface::EquilibriumParams params, Run const& run) {
    params.edge = params.edge == surface::Edge::open ? surface::Edge::closed : params.edge;
    surface::RebuiltTerrain rebuilt =
        surface::rebuild(channels, fields, rebuild_params_of(plan.recipe.surface->equilibrium, params), run);
    return {.land = std::move(rebuilt.terrain),
            .params = params,
            .rebuilt = RebuildStatistics{rebuilt.survey.source_km2, rebuilt.survey.spacing_m, rebuilt.survey.concavity,
                                         rebuilt.smooth_slope_deg},
            .findings = params.bring_to_target ? std::vector<Finding>{} : doubts_of(rebuilt.survey)};
}

/// Correlation of gradients at the distance at which the DEM of surface.like has it.
double correlation_of(Raster<float> const& dem, recipe::LikeDem const& like, Run const& run) {
    auto const lag = std::ranges::find(measure::texture_lags_m, like.lag_m) - measure::texture_lags_m.begin();
    return measure::gradient_texture(dem, {}, run).correlation.at(static_cast<std::size_t>(lag));
}

/// Solves, and again with another roughness until gradients are correlated as in the DEM of surface.like.
template <class Solve>
Solved with_texture(recipe::LikeDem const& like, surface::EquilibriumParams params, Solve const& solve,
                    Run const& run) {
    constexpr double close = 0.01;
    constexpr double worth_a_word = 0.03;
    constexpr int most_rounds = 4;
    constexpr double most_roughness = 0.88;
    double change = -0.22; // of the correlation by roughness: measured in Big Tujunga and Jacksboro
    Solved solved = solve(params);
    solved.like = LikeStatistics{like.mean_slope_deg, like.correlation, like.lag_m, params.roughness, std::nan("")};
    if (std::isnan(like.correlation) || params.roughness != surface::EquilibriumParams{}.roughness) {
        return solved;
    }
    double here = correlation_of(solved.land.dem, like, run);
    for (int round = 1; round < most_rounds && std::fabs(here - like.correlation) > close; ++round) {
        double const before = params.roughness;
        params.roughness = std::clamp(before + (like.correlation - here) / change, 0.0, most_roughness);
        if (params.roughness == before) {
            break;
        }
        solved = solve(params);
        double const there = correlation_of(solved.land.dem, like, run);
        change = std::min((there - here) / (params.roughness - before), -0.05);
        here = there;
    }
    solved.like = LikeStatistics{like.mean_slope_deg, like.correlation, like.lag_m, params.roughness, here};
    solved.findings.push_back(
        {.kind = "like",
         .amount = here,
         .text = fmt::format("with a roughness of {:.2g} gradients {:g} m apart are correlated by {:.2f} ({:.2f} in "
                             "the DEM)",
                             params.roughness, like.lag_m, here, like.correlation),
         .key = "surface.like",
         .numbers = {{"roughness", params.roughness}, {"lag", like.lag_m, "m"}, {"wanted", like.correlation, "1"}}});
    if (std::fabs(here - like.correlation) > worth_a_word) {
        solved.findings.push_back(
            {.kind = "texture_missed",
             .amount = here,
             .text = fmt::format("the texture of surface.like cannot be reached with surface.roughness alone: the "
                                 "terrain is {} than that DEM",
                                 here < like.correlation ? "rougher" : "smoother"),
             .key = "surface.like",
             .numbers = {{"wanted", like.correlation, "1"}}});
    }
    return solved;
}

/// Solves for the land.
Solved solve(recipe::Plan const& plan, Planform const& planform, Channels const& channels, StageLog& stage_log,
             Run const& run) {
    surface::EquilibriumFields const fields = equilibrium_fields(plan, planform, channels, run);
    run.at(0.0, fmt::format("fill {} cells", planform.grid.cells()).c_str());
    surface::EquilibriumParams const params =
        params_of(plan, plan.recipe.network->heights, edge_of(plan, planform, fields.land, channels));
    if (rebuilds(plan) && plan.recipe.surface->equilibrium.edge == surface::Edge::open) {
        stage_log.find({.kind = "key_without_effect",
                        .text = "surface.edge = \"open\" is not used: around heights of a file the terrain ends at the "
                                "grid, and all water drains to the rivers",
                        .key = "surface.edge"});
    }
    auto const solve_with = [&](surface::EquilibriumParams const& with) {
        return rebuilds(plan) ? rebuild_terrain(plan, channels, fields, with, run)
                              : Solved{surface::equilibrium(channels, fields, with, run), with};
    };
    Solved solved = stage_log.stage(
        "fill", [&] { return plan.like ? with_texture(*plan.like, params, solve_with, run) : solve_with(params); });
    stage_log.find(solved.findings);
    return solved;
}

EquilibriumStatistics statistics_of(Solved const& solved, Channels const& channels) {
    surface::EquilibriumTerrain const& land = solved.land;
    EquilibriumStatistics statistics;
    statistics.edge = solved.params.edge;
    statistics.rebuilt = solved.rebuilt;
    statistics.like = solved.like;
    statistics.channel_cells = static_cast<std::int64_t>(channels.cell.size());
    statistics.shortened_cells = static_cast<std::int64_t>(land.shortened.size());
    statistics.walled_cells = static_cast<std::int64_t>(land.walled.size());
    statistics.max_lowered_m = land.max_lowered_m;
    statistics.p95_lowered_m = land.p95_lowered_m;
    statistics.rise = land.rise;
    statistics.in_region = land.in_region;
    statistics.inflows = land.inflows;
    return statistics;
}

/// Warns if a requested region is not possible.
void warn_of_region(surface::EquilibriumTerrain const& land, std::optional<double> asked, StageLog& stage_log) {
    if (!land.in_region && asked.value_or(1.0) > 1.0) {
        stage_log.find({.kind = "key_without_effect",
                        .text = fmt::format("surface.region = {:.6g} is not used: it needs an open edge, rivers that "
                                            "leave the grid with heights of thalweg's own, and 64 cells a side",
                                            *asked),
                        .key = "surface.region"});
    }
}

void warn_of_heights(Raster<float> const& dem, bool rebuilt, StageLog& stage_log) {
    constexpr float most_m = 9000.0F;
    float low = std::numeric_limits<float>::infinity();
    float high = -low;
    for (float const z : dem.values()) {
        low = z < low ? z : low;
        high = z > high ? z : high;
    }
    if (high - low > most_m) {
        stage_log.find(
            {.kind = "high_terrain",
             .amount = static_cast<double>(high - low),
             .text = fmt::format("the terrain is {:.0f} m high, higher than any on Earth", high - low),
             .remedy = rebuilt ? "Land far from all rivers rises with the distance: add rivers there, or leave it out "
                                 "with surface.mask"
                               : "--set surface.relief=1000 gives it a height of 1000 m",
             .key = rebuilt ? "surface.mask" : "surface.relief"});
    }
}

/// What keeps the level of a lake up: the next lake with a level downstream, or the end of the river.
std::string hindrance(WithLakes const& flooded, network::Lake const& lake, Raster<float> const& dem) {
    Channels const& channels = flooded.rivers.channels;
    std::int64_t cells = 0;
    std::int64_t at = lake.outlet;
    do {
        if (channels.receiver[at] < 0) {
            return fmt::format("its river ends at {:.6g} m, cells downstream: {}", dem[channels.cell[at]], cells);
        }
        at = channels.receiver[at];
        ++cells;
    } while (std::isnan(channels.lake_z[at]));
    auto const below = std::ranges::find(flooded.lakes, at, &network::Lake::outlet);
    return fmt::format("lake {} stands at {:.6g} m, cells downstream: {}", below->label, dem[channels.cell[at]], cells);
}

/// Notes, and a warning, on lakes that have not the levels asked.
std::vector<Finding> missed_levels(WithLakes const& flooded, Raster<float> const& dem) {
    std::vector<Finding> notes;
    if (!flooded.by_levels) {
        return notes;
    }
    Channels const& channels = flooded.rivers.channels;
    for (network::Lake const& lake : flooded.lakes) {
        float const wanted = channels.lake_z[lake.outlet];
        std::int64_t const cell = channels.cell[lake.outlet];
        if (std::isnan(wanted) || dem[cell] == wanted) {
            continue;
        }
        Vec2 const at = dem.grid().centre(dem.grid().at(cell));
        notes.push_back({"lake_level", lake.label, at, static_cast<double>(dem[cell]),
                         fmt::format("lake {} at ({:.3f}, {:.3f}) has the level {:.6g} m, not {:.6g} m: {}", lake.label,
                                     at.x, at.y, dem[cell], wanted, hindrance(flooded, lake, dem))});
    }
    append(notes, off_levels(notes));
    return notes;
}

Valley valley_of(Channels const& channels, Raster<float> const& dem) {
    Valley valley{Raster<float>(dem.grid(), none)};
    for (std::int64_t const cell : channels.cell) {
        valley.z[cell] = dem[cell];
    }
    return valley;
}

} // namespace

EquilibriumResult draw_in_equilibrium(recipe::Plan const& plan, Planform const& planform, StageLog& stage_log,
                                      Run const& run) {
    recipe::Heights const heights = plan.recipe.network->heights;
    std::optional<RaisedRivers> raised;
    if (!recipe::heights_follow_terrain(plan.recipe)) {
        raised = raise_rivers(plan, planform, stage_log, run);
    }
    EquilibriumResult result;
    result.heights = raised ? raised->statistics : HeightsStatistics{};
    network::ChannelsParams drawing;
    drawing.look_cells = rebuilds(plan) ? 0 : drawing.look_cells; // heights decide where water goes
    network::ChannelsOfArcs rivers =
        stage_log.stage("channels", [&] { return network::channels(planform.network, planform.grid, drawing, run); });
    stage_log.find(rivers.notes);
    if (heights != recipe::Heights::graded) {
        rivers.channels.z = asked_heights(raised->network, rivers.channels, heights);
    }
    WithLakes flooded = with_lakes(plan, planform, std::move(rivers), run);
    stage_log.find(flooded.notes);
    result.lakes = std::ssize(flooded.lakes);
    Solved solved = solve(plan, planform, flooded.rivers.channels, stage_log, run);
    surface::EquilibriumTerrain& surface = solved.land;
    stage_log.find(missed_levels(flooded, surface.dem));
    rivers = std::move(flooded.rivers);
    result.statistics = statistics_of(solved, rivers.channels);
    result.checks = target_checks(surface, solved.params, flooded.by_levels, stage_log);
    bool const given = solved.params.heights != surface::RiverHeights::graded;
    if (given || flooded.by_levels || solved.params.heads == surface::Heads::kept) {
        char const* const remedy = given               ? R"(network.heights = "graded" or "soft" lets rivers follow it)"
                                   : flooded.by_levels ? "Levels of lakes nearer to the terrain need fewer"
                                                       : "A smaller grid.cell gives slopes room between rivers";
        result.checks.push_back(wall_check(surface, rivers.channels, remedy, stage_log));
    }
    if (solved.rebuilt) {
        bool const has_sea =
            solved.params.edge == surface::Edge::coast || solved.params.edge == surface::Edge::mainland;
        result.checks.push_back(valley_check(surface.dem, rivers.channels, has_sea, stage_log, run));
    }
    warn_of_region(surface, plan.recipe.surface->equilibrium.region, stage_log);
    warn_of_heights(surface.dem, solved.rebuilt.has_value(), stage_log);
    Typed typed{planform.network, planform.types};
    if (!surface.shortened.empty()) {
        network::Shortened shortened = network::shorten(planform.network, rivers, surface.shortened);
        stage_log.find(shortened.notes);
        rivers = std::move(shortened.drawn);
        typed = type_rivers(std::move(shortened.network), *plan.recipe.network, run);
    }
    stage_log.say(fmt::format("{}x{}, in equilibrium with {} cells of rivers", planform.grid.width,
                              planform.grid.height, rivers.channels.cell.size()));
    result.rivers = rivers_of(network::elevate_from_dem(typed.network, rivers.channels, surface.dem),
                              std::move(typed.types), planform.file.clues);
    result.valley = valley_of(rivers.channels, surface.dem);
    result.channels = std::move(rivers.channels);
    result.dem = std::move(surface.dem);
    return result;
}

WithSideValleys with_side_valleys(recipe::Plan const& plan, Rivers rivers, Valley valley, Channels const& channels,
                                  Raster<float> const& dem, flow::FlowField const& drainage, StageLog& stage_log,
                                  Run const& run) {
    if (!recipe::adds_side_valleys(plan.recipe)) {
        return {std::move(rivers), std::move(valley), {}};
    }
    std::int64_t const support_cells = plan.recipe.network->support_cells;
    network::SideValleys made = stage_log.stage("valleys", [&] {
        return network::side_valleys(rivers.network, channels, dem, drainage, {support_cells}, run);
    });
    stage_log.say(fmt::format("{} arcs that drain {} cells or more, besides {} of the input", made.grown, support_cells,
                              static_cast<std::int64_t>(made.network.planform.arc_count()) - made.grown));
    Grid const& grid = dem.grid();
    // Lengths at which each is kept.
    Typed typed =
        type_rivers(network::prune(made.network.planform, {0.0, grid.cell_m}, run).network, *plan.recipe.network, run);
    ElevatedNetwork network = std::move(made.network);
    network.planform = std::move(typed.network);
    Valley cells = std::move(valley);
    for (ArcId a = 0; a < network.planform.arc_count(); ++a) {
        Arc const& of = network.planform.arc(a);
        bool const leaves = network.planform.out(network.planform.to(a)) == no_arc;
        for (std::size_t v = 0; !of.is_input && v + (leaves ? 0 : 1) < of.line.size();
             ++v) { // the last may join a line
            std::int64_t const cell = grid.index(grid.cell_of(of.line[v]));
            cells.z[cell] = dem[cell];
        }
    }
    return {rivers_of(std::move(network), std::move(typed.types), std::move(rivers.clues)),
            std::move(cells),
            {made.grown, made.left_out}};
}

} // namespace thalweg::make
