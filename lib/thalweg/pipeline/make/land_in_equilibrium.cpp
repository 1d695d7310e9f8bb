// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/internal/land_in_equilibrium.hpp>

#include <thalweg/blend/mask_polygons.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/io/raster/read_polygons.hpp>
#include <thalweg/network/channels/channels.hpp>
#include <thalweg/network/channels/choose_lakes.hpp>
#include <thalweg/network/channels/flood_lakes.hpp>
#include <thalweg/network/channels/shorten.hpp>
#include <thalweg/network/channels/side_valleys.hpp>
#include <thalweg/network/elevation/channel_heights.hpp>
#include <thalweg/network/elevation/raise_from_land.hpp>
#include <thalweg/network/order/order.hpp>
#include <thalweg/network/vectorise/prune.hpp>
#include <thalweg/pipeline/make/internal/read_cells.hpp>
#include <thalweg/pipeline/make/internal/rivers.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_files.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace thalweg::pipeline {

namespace {

constexpr float none = std::numeric_limits<float>::quiet_NaN();

surface::RiverHeights use_of(Heights heights) {
    return heights == Heights::graded ? surface::RiverHeights::graded
           : heights == Heights::soft ? surface::RiverHeights::soft
                                      : surface::RiverHeights::fixed;
}

bool has_sea(Mask const& land) {
    return std::any_of(land.values().begin(), land.values().end(), [](std::uint8_t is_land) { return is_land == 0; });
}

surface::Edge edge_of(Recipe const& recipe, Terrain const& terrain, Mask const& land) {
    bool const by_coastlines = recipe.network->source == Source::lines && terrain.land.cells() > 0;
    return by_coastlines ? surface::Edge::mainland : has_sea(land) ? surface::Edge::coast : surface::Edge::open;
}

surface::EquilibriumParams params_of(Recipe& recipe, surface::Edge edge) {
    EquilibriumRecipe& wanted = recipe.surface->equilibrium;
    wanted.edge = wanted.edge.value_or(edge);
    double const relief_m = recipe.surface->dilate.relief_m;
    surface::EquilibriumParams params;
    params.theta = recipe.network->concavity;
    params.heights = use_of(recipe.network->heights);
    params.bring_to_target = wanted.mean_slope_deg || relief_m > 0.0;
    if (relief_m > 0.0) {
        params.relief_m = relief_m;
    } else if (params.bring_to_target) {
        params.mean_slope_deg = *wanted.mean_slope_deg;
    } else {
        bool const drawn = recipe.network->source == Source::lines;
        params.mean_slope_deg = drawn ? usual_slope_deg(recipe.grid.cell_m) : params.mean_slope_deg;
        if (params.heights == surface::RiverHeights::graded) { // given ones have a slope of their own
            wanted.mean_slope_deg = params.mean_slope_deg;
        }
    }
    params.hillslope_cells =
        wanted.hillslope_m > 0.0 ? wanted.hillslope_m / recipe.grid.cell_m : params.hillslope_cells;
    params.floor_width = wanted.floor_width;
    params.roughness = wanted.roughness;
    params.edge = *wanted.edge;
    params.seed = recipe.seed;
    return params;
}

/// The heights that are asked of channels: all that the rivers have, or those of sources and where they end.
std::vector<float> asked_heights(RaisedNetwork const& rivers, Channels const& channels, Heights heights) {
    std::vector<float> z = network::channel_heights(rivers, channels);
    if (heights == Heights::ends) {
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

/// Cells that are land by both masks, of which either may be empty; and those of rivers.
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

surface::EquilibriumFields fields_of(Terrain const& terrain, Channels const& channels, Run const& run) {
    Recipe const& recipe = terrain.recipe;
    Grid const& grid = terrain.grid;
    SurfaceRecipe const& wanted = *recipe.surface;
    surface::EquilibriumFields fields;
    fields.land = land_of(read_mask_of_land(file_in(recipe, recipe.surface->mask), grid), terrain.land, channels);
    fields.uplift = read_field(file_in(recipe, wanted.equilibrium.uplift), grid, "surface.uplift", run);
    fields.erodibility = read_field(file_in(recipe, wanted.equilibrium.erodibility), grid, "surface.erodibility", run);
    return fields;
}

/// What was asked of the land, and what came out.
void check_target(Terrain& terrain, surface::EquilibriumLand const& land, surface::EquilibriumParams const& params,
                  Run const& run) {
    constexpr double allowed = 0.05;
    if (params.heights != surface::RiverHeights::graded && !params.bring_to_target) {
        return; // nothing was
    }
    double const error = std::fabs(land.target_share - 1.0);
    terrain.checks.push_back({params.relief_m ? "relief_error" : "mean_slope_error", error, allowed, error <= allowed});
    if (error > allowed) {
        double const asked = params.relief_m ? *params.relief_m : params.mean_slope_deg;
        char const* const unit = params.relief_m ? "m" : "degrees";
        std::string const text =
            fmt::format("surface.{} = {:.6g} {} cannot be reached with the heights of the rivers: it is {:.4g} {}",
                        params.relief_m ? "relief" : "mean_slope", asked, unit, land.target_share * asked, unit);
        run.say("warning: " + text);
        terrain.findings.push_back({"target_missed", 0, {}, land.target_share * asked, text});
    }
}

double most_walled(Channels const& channels) {
    return 0.01 * static_cast<double>(channels.cell.size());
}

bool too_walled(surface::EquilibriumLand const& land, Channels const& channels) {
    return static_cast<double>(land.walled.size()) > most_walled(channels);
}

/// River cells that only walls hold up.
void check_walls(Terrain& terrain, surface::EquilibriumLand const& land, Channels const& channels, Run const& run) {
    constexpr std::size_t listed = 1000;
    bool const ok = !too_walled(land, channels);
    terrain.checks.push_back(
        {"walled_cells", static_cast<double>(land.walled.size()), std::floor(most_walled(channels)), ok});
    if (!ok) {
        run.say(fmt::format("warning: {} of {} river cells stand on walls above the terrain. network.heights = "
                            "\"graded\" or \"soft\" lets rivers follow it.",
                            land.walled.size(), channels.cell.size()));
    }
    for (std::size_t i = 0; i < std::min(listed, land.walled.size()); ++i) {
        std::int64_t const cell = channels.cell[static_cast<std::size_t>(land.walled[i])];
        Vec2 const at = terrain.grid.centre(terrain.grid.at(cell));
        terrain.findings.push_back({"walled_cell", 0, at, static_cast<double>(land.dem[cell]),
                                    fmt::format("the river at ({:.1f}, {:.1f}) stands {:.5g} m high, on a wall: the "
                                                "land around is lower",
                                                at.x, at.y, land.dem[cell])});
    }
}

void take_notes(Terrain& terrain, std::vector<Finding> const& notes) {
    terrain.story.repairs.insert(terrain.story.repairs.end(), notes.begin(), notes.end());
}

/// One note for all lakes of a file that no cell shows.
std::vector<Finding> unseen_lakes(Polygons const& polygons, Raster<std::int32_t> const& labels) {
    std::vector<std::uint8_t> seen(polygons.polygons.size() + 1);
    for (std::int32_t const label : labels.values()) {
        seen[static_cast<std::size_t>(label)] = 1;
    }
    auto const first = std::find(seen.begin() + 1, seen.end(), 0);
    if (first == seen.end()) {
        return {};
    }
    auto const count = std::count(first, seen.end(), 0);
    Polygon const& one = polygons.polygons[static_cast<std::size_t>(first - seen.begin() - 1)];
    return {{"lake_left_out", one.feature, one.rings.front().front(), static_cast<double>(count),
             fmt::format("{} of the {} lakes of {} lie off the grid, between the centres of its cells or under others",
                         count, polygons.polygons.size(), polygons.name)}};
}

/// By cell the number of its lake, 0 for none; without cells where no lakes are asked for.
Raster<std::int32_t> lakes_of(Terrain& terrain, network::ChannelsOfArcs const& rivers, Run const& run) {
    EquilibriumRecipe const& wanted = terrain.recipe.surface->equilibrium;
    if (wanted.lake_share > 0.0) {
        measure::ContributingAreas const areas = measure::areas_nearest(terrain.network.plan, terrain.grid, run);
        return network::choose_lakes(rivers, areas.ds_area_m2,
                                     {.share = wanted.lake_share, .seed = terrain.recipe.seed}, run);
    }
    if (wanted.lakes.empty()) {
        return {};
    }
    Polygons const polygons = io::read_polygons(file_in(terrain.recipe, wanted.lakes), terrain.grid.crs, run);
    Raster<std::int32_t> labels = blend::number_polygons(polygons, terrain.grid);
    take_notes(terrain, unseen_lakes(polygons, labels));
    return labels;
}

void tell(Terrain& terrain, surface::EquilibriumLand const& land, Channels const& channels) {
    EquilibriumStory& story = terrain.equilibrium.emplace();
    story.channel_cells = static_cast<std::int64_t>(channels.cell.size());
    story.shortened_cells = static_cast<std::int64_t>(land.shortened.size());
    story.walled_cells = static_cast<std::int64_t>(land.walled.size());
    story.max_lowered_m = land.max_lowered_m;
    story.p95_lowered_m = land.p95_lowered_m;
    story.rise = land.rise;
}

void warn_of_heights(Raster<float> const& dem, Run const& run) {
    constexpr float most_m = 9000.0F;
    float low = std::numeric_limits<float>::infinity();
    float high = -low;
    for (float const z : dem.values()) {
        low = z < low ? z : low;
        high = z > high ? z : high;
    }
    if (high - low > most_m) {
        run.say(
            fmt::format("warning: the terrain is {:.0f} m high, higher than any on Earth. --set surface.relief=1000 "
                        "gives it a height of 1000 m.",
                        high - low));
    }
}

/// Lays the lakes that are asked for into the channels.
void flood(Terrain& terrain, network::ChannelsOfArcs& rivers, Run const& run) {
    Raster<std::int32_t> const labels = lakes_of(terrain, rivers, run);
    if (labels.cells() == 0) {
        return;
    }
    network::Flooded flooded = network::flood_lakes(rivers, labels, run);
    take_notes(terrain, flooded.notes);
    terrain.lakes = static_cast<std::int64_t>(flooded.lakes.size());
    rivers = std::move(flooded.drawn);
}

Valley valley_of(Channels const& channels, Raster<float> const& dem) {
    Valley valley{Raster<float>(dem.grid(), none)};
    for (std::int64_t const cell : channels.cell) {
        valley.z[cell] = dem[cell];
    }
    return valley;
}

} // namespace

double usual_slope_deg(double cell_m) {
    constexpr double finest_m = 30.0;
    constexpr double half_m = 400.0;
    double const fine_deg = surface::EquilibriumParams{}.mean_slope_deg;
    if (cell_m <= finest_m) {
        return fine_deg;
    }
    auto const share = [](double m) { return 1.0 / (1.0 + exact::pow(m / half_m, 0.9)); };
    double const fine = fine_deg / 180.0 * exact::pi;
    double const tangent = exact::sin(fine) / exact::cos(fine) * share(cell_m) / share(finest_m);
    double const degrees = exact::atan2(tangent, 1.0) / exact::pi * 180.0;
    return std::max(0.5, std::round(2.0 * degrees) / 2.0);
}

bool in_equilibrium(Recipe const& recipe) {
    return recipe.network && recipe.surface && recipe.surface->method == Method::equilibrium;
}

void draw_in_equilibrium(Terrain& terrain, Diary& diary, Run const& run) {
    Recipe& recipe = terrain.recipe;
    network::ChannelsOfArcs rivers =
        diary.stage("channels", [&] { return network::channels(terrain.network.plan, terrain.grid, {}, run); });
    take_notes(terrain, rivers.notes);
    if (recipe.network->heights != Heights::graded) {
        rivers.channels.z = asked_heights(terrain.network, rivers.channels, recipe.network->heights);
    }
    flood(terrain, rivers, run);
    surface::EquilibriumFields const fields = fields_of(terrain, rivers.channels, run);
    run.at(0.0, fmt::format("fill {} cells", terrain.grid.cells()).c_str());
    surface::Edge const edge = edge_of(recipe, terrain, fields.land);
    surface::EquilibriumParams params = params_of(recipe, edge);
    auto const solve = [&] {
        return diary.stage("fill", [&] { return surface::equilibrium(rivers.channels, fields, params, run); });
    };
    surface::EquilibriumLand land = solve();
    if (terrain.story.heights_of_file && too_walled(land, rivers.channels)) {
        run.say(fmt::format("warning: the heights in {} would put {} of {} river cells on walls above the terrain. "
                            "Rivers are lowered there: network.heights = \"soft\"; \"file\" keeps their heights.",
                            recipe.network->lines.path, land.walled.size(), rivers.channels.cell.size()));
        recipe.network->heights = Heights::soft;
        params = params_of(recipe, edge);
        land = solve();
    }
    tell(terrain, land, rivers.channels);
    check_target(terrain, land, params, run);
    if (params.heights != surface::RiverHeights::graded) {
        check_walls(terrain, land, rivers.channels, run);
    }
    warn_of_heights(land.dem, run);
    if (!land.shortened.empty()) {
        network::Shortened shortened = network::shorten(terrain.network.plan, rivers, land.shortened);
        take_notes(terrain, shortened.notes);
        terrain.network.plan = std::move(shortened.network);
        rivers = std::move(shortened.drawn);
        assign_types(terrain.network.plan, terrain, run);
    }
    diary.say(fmt::format("{}x{}, in equilibrium with {} cells of rivers", terrain.grid.width, terrain.grid.height,
                          rivers.channels.cell.size()));
    terrain.network = network::raise_from_land(terrain.network.plan, rivers.channels, land.dem);
    terrain.orders = network::order(terrain.network.plan);
    terrain.streams = network::count_streams(terrain.network.plan);
    terrain.valley = valley_of(rivers.channels, land.dem);
    terrain.channels = std::move(rivers.channels);
    terrain.surface.emplace();
    terrain.surface->dem = std::move(land.dem);
}

void add_side_valleys(Terrain& terrain, measure::Drainage const& drainage, Diary& diary, Run const& run) {
    if (!terrain.recipe.network || !terrain.recipe.network->fill_space) {
        return;
    }
    network::SideValleys made = diary.stage("valleys", [&] {
        return network::side_valleys(terrain.network, terrain.channels,
                                     {terrain.surface->dem, drainage.direction, drainage.area_cells},
                                     {terrain.recipe.network->support_cells}, run);
    });
    terrain.equilibrium->side_valleys = made.grown;
    terrain.equilibrium->side_valleys_left_out = made.left_out;
    diary.say(fmt::format("{} arcs that drain {} cells or more, besides {} of the input", made.grown,
                          terrain.recipe.network->support_cells,
                          static_cast<std::int64_t>(made.network.plan.arc_count()) - made.grown));
    terrain.network = std::move(made.network);
    terrain.network.plan =
        network::prune(terrain.network.plan, {0.0, terrain.grid.cell_m}, run).network; // lengths at which each is kept
    assign_types(terrain.network.plan, terrain, run);
    terrain.orders = network::order(terrain.network.plan);
    terrain.streams = network::count_streams(terrain.network.plan);
    for (ArcId arc = 0; arc < terrain.network.plan.arc_count(); ++arc) {
        Arc const& of = terrain.network.plan.arc(arc);
        bool const leaves = terrain.network.plan.out_arcs(terrain.network.plan.to(arc)).size() == 0;
        for (std::size_t v = 0; !of.given && v + (leaves ? 0 : 1) < of.line.size(); ++v) { // the last may join a line
            std::int64_t const cell = terrain.grid.index(terrain.grid.cell_of(of.line[v]));
            terrain.valley.z[cell] = terrain.surface->dem[cell];
        }
    }
}

} // namespace thalweg::pipeline
