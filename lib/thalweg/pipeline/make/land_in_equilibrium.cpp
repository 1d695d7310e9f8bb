// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/internal/land_in_equilibrium.hpp>

#include <thalweg/blend/mask_polygons.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/flow/catchments/areas.hpp>
#include <thalweg/flow/flow_field.hpp>
#include <thalweg/io/raster/read_polygons.hpp>
#include <thalweg/network/channels/channels.hpp>
#include <thalweg/network/channels/choose_lakes.hpp>
#include <thalweg/network/channels/flood_lakes.hpp>
#include <thalweg/network/channels/shorten.hpp>
#include <thalweg/network/channels/side_valleys.hpp>
#include <thalweg/network/elevation/channel_heights.hpp>
#include <thalweg/network/elevation/elevate_from_dem.hpp>
#include <thalweg/network/order/order.hpp>
#include <thalweg/network/vectorise/prune.hpp>
#include <thalweg/pipeline/make/internal/type_rivers.hpp>
#include <thalweg/pipeline/plan/internal/append.hpp>
#include <thalweg/pipeline/plan/internal/read_cells.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_asks.hpp>
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

surface::Edge edge_of(DrawnTerrain const& drawn, Mask const& land) {
    bool const by_coastlines = drawn.recipe.network->source == Source::lines && drawn.land.cells() > 0;
    return by_coastlines ? surface::Edge::mainland : has_sea(land) ? surface::Edge::coast : surface::Edge::open;
}

/// What a recipe asks of the land, and the recipe with what it left open.
struct Asked {
    Recipe recipe;
    surface::EquilibriumParams params;
};

Asked asked_of(Recipe recipe, surface::Edge edge) {
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
    return {std::move(recipe), params};
}

/// The heights that are asked of channels: all that the rivers have, or those of sources and where they end.
std::vector<float> asked_heights(ElevatedNetwork const& rivers, Channels const& channels, Heights heights) {
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

surface::EquilibriumFields fields_of(DrawnTerrain const& drawn, Channels const& channels, Run const& run) {
    Recipe const& recipe = drawn.recipe;
    Grid const& grid = drawn.grid;
    SurfaceRecipe const& wanted = *recipe.surface;
    surface::EquilibriumFields fields;
    fields.land = land_of(read_mask_of_land(file_in(recipe, recipe.surface->mask), grid), drawn.land, channels);
    fields.uplift = read_field(file_in(recipe, wanted.equilibrium.uplift), grid, "surface.uplift", run);
    fields.erodibility = read_field(file_in(recipe, wanted.equilibrium.erodibility), grid, "surface.erodibility", run);
    return fields;
}

/// What was asked of the land, and what came out.
DrawnTerrain with_target_checked(DrawnTerrain drawn, surface::EquilibriumTerrain const& land,
                                 surface::EquilibriumParams const& params, Run const& run) {
    constexpr double allowed = 0.05;
    if (params.heights != surface::RiverHeights::graded && !params.bring_to_target) {
        return drawn; // nothing was
    }
    double const error = std::fabs(land.target_share - 1.0);
    drawn.checks.push_back({params.relief_m ? "relief_error" : "mean_slope_error", error, allowed, error <= allowed});
    if (error > allowed) {
        double const asked = params.relief_m ? *params.relief_m : params.mean_slope_deg;
        char const* const unit = params.relief_m ? "m" : "degrees";
        std::string const text =
            fmt::format("surface.{} = {:.6g} {} cannot be reached with the heights of the rivers: it is {:.4g} {}",
                        params.relief_m ? "relief" : "mean_slope", asked, unit, land.target_share * asked, unit);
        run.say("warning: " + text);
        drawn.findings.push_back({"target_missed", 0, {}, land.target_share * asked, text});
    }
    return drawn;
}

double most_walled(Channels const& channels) {
    return 0.01 * static_cast<double>(channels.cell.size());
}

bool too_walled(surface::EquilibriumTerrain const& land, Channels const& channels) {
    return static_cast<double>(land.walled.size()) > most_walled(channels);
}

/// River cells that only walls hold up.
DrawnTerrain with_walls_checked(DrawnTerrain drawn, surface::EquilibriumTerrain const& land, Channels const& channels,
                                Run const& run) {
    constexpr std::size_t listed = 1000;
    bool const ok = !too_walled(land, channels);
    drawn.checks.push_back(
        {"walled_cells", static_cast<double>(land.walled.size()), std::floor(most_walled(channels)), ok});
    if (!ok) {
        run.say(fmt::format("warning: {} of {} river cells stand on walls above the terrain. network.heights = "
                            "\"graded\" or \"soft\" lets rivers follow it.",
                            land.walled.size(), channels.cell.size()));
    }
    for (std::size_t i = 0; i < std::min(listed, land.walled.size()); ++i) {
        std::int64_t const cell = channels.cell[static_cast<std::size_t>(land.walled[i])];
        Vec2 const at = drawn.grid.centre(drawn.grid.at(cell));
        drawn.findings.push_back({"walled_cell", 0, at, static_cast<double>(land.dem[cell]),
                                  fmt::format("the river at ({:.1f}, {:.1f}) stands {:.5g} m high, on a wall: the "
                                              "land around is lower",
                                              at.x, at.y, land.dem[cell])});
    }
    return drawn;
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
struct Lakes {
    Raster<std::int32_t> labels;
    std::vector<Finding> notes = {};
};

Lakes lakes_of(DrawnTerrain const& drawn, network::ChannelsOfArcs const& rivers, Run const& run) {
    EquilibriumRecipe const& wanted = drawn.recipe.surface->equilibrium;
    if (wanted.lake_share > 0.0) {
        flow::ContributingAreas const areas = flow::areas_nearest(drawn.network.plan, drawn.grid, run);
        return {network::choose_lakes(rivers, areas.ds_area_m2, {.share = wanted.lake_share, .seed = drawn.recipe.seed},
                                      run)};
    }
    if (wanted.lakes.empty()) {
        return {};
    }
    Polygons const polygons = io::read_polygons(file_in(drawn.recipe, wanted.lakes), drawn.grid.crs, run);
    Lakes lakes{blend::number_polygons(polygons, drawn.grid)};
    lakes.notes = unseen_lakes(polygons, lakes.labels);
    return lakes;
}

EquilibriumStory story_of(surface::EquilibriumTerrain const& land, Channels const& channels) {
    EquilibriumStory story;
    story.channel_cells = static_cast<std::int64_t>(channels.cell.size());
    story.shortened_cells = static_cast<std::int64_t>(land.shortened.size());
    story.walled_cells = static_cast<std::int64_t>(land.walled.size());
    story.max_lowered_m = land.max_lowered_m;
    story.p95_lowered_m = land.p95_lowered_m;
    story.rise = land.rise;
    return story;
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

/// Channels with the lakes that are asked for.
struct WithLakes {
    network::ChannelsOfArcs rivers;
    std::int64_t lakes = 0;
    std::vector<Finding> notes = {};
};

WithLakes with_lakes(network::ChannelsOfArcs rivers, DrawnTerrain const& drawn, Run const& run) {
    Lakes lakes = lakes_of(drawn, rivers, run);
    if (lakes.labels.cells() == 0) {
        return {std::move(rivers)};
    }
    network::Flooded flooded = network::flood_lakes(rivers, lakes.labels, run);
    append(lakes.notes, flooded.notes);
    return {std::move(flooded.drawn), static_cast<std::int64_t>(flooded.lakes.size()), std::move(lakes.notes)};
}

/// The land with other arcs in plan, and the types that they get.
DrawnTerrain with_types(DrawnTerrain drawn, StreamNetwork plan, Run const& run) {
    Typed typed = type_rivers(std::move(plan), *drawn.recipe.network, run);
    drawn.network.plan = std::move(typed.plan);
    if (!typed.types.type.empty()) {
        drawn.types = std::move(typed.types);
    }
    return drawn;
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
    auto const share = [](double m) { return 1.0 / (1.0 + portable::pow(m / half_m, 0.9)); };
    double const fine = fine_deg / 180.0 * portable::pi;
    double const tangent = portable::sin(fine) / portable::cos(fine) * share(cell_m) / share(finest_m);
    double const degrees = portable::atan2(tangent, 1.0) / portable::pi * 180.0;
    return std::max(0.5, std::round(2.0 * degrees) / 2.0);
}

DrawnTerrain draw_in_equilibrium(DrawnTerrain drawn, bool heights_of_file, Diary& diary, Run const& run) {
    network::ChannelsOfArcs rivers =
        diary.stage("channels", [&] { return network::channels(drawn.network.plan, drawn.grid, {}, run); });
    append(drawn.notes, rivers.notes);
    Heights const heights = drawn.recipe.network->heights;
    if (heights != Heights::graded) {
        rivers.channels.z = asked_heights(drawn.network, rivers.channels, heights);
    }
    WithLakes flooded = with_lakes(std::move(rivers), drawn, run);
    append(drawn.notes, flooded.notes);
    drawn.lakes = flooded.lakes;
    rivers = std::move(flooded.rivers);
    surface::EquilibriumFields const fields = fields_of(drawn, rivers.channels, run);
    run.at(0.0, fmt::format("fill {} cells", drawn.grid.cells()).c_str());
    surface::Edge const edge = edge_of(drawn, fields.land);
    Asked asked = asked_of(std::move(drawn.recipe), edge);
    auto const solve = [&] {
        return diary.stage("fill", [&] { return surface::equilibrium(rivers.channels, fields, asked.params, run); });
    };
    surface::EquilibriumTerrain land = solve();
    if (heights_of_file && too_walled(land, rivers.channels)) {
        run.say(fmt::format("warning: the heights in {} would put {} of {} river cells on walls above the terrain. "
                            "Rivers are lowered there: network.heights = \"soft\"; \"file\" keeps their heights.",
                            asked.recipe.network->lines.path, land.walled.size(), rivers.channels.cell.size()));
        asked.recipe.network->heights = Heights::soft;
        asked = asked_of(std::move(asked.recipe), edge);
        land = solve();
    }
    drawn.recipe = std::move(asked.recipe);
    drawn.equilibrium = story_of(land, rivers.channels);
    drawn = with_target_checked(std::move(drawn), land, asked.params, run);
    if (asked.params.heights != surface::RiverHeights::graded) {
        drawn = with_walls_checked(std::move(drawn), land, rivers.channels, run);
    }
    warn_of_heights(land.dem, run);
    if (!land.shortened.empty()) {
        network::Shortened shortened = network::shorten(drawn.network.plan, rivers, land.shortened);
        append(drawn.notes, shortened.notes);
        rivers = std::move(shortened.drawn);
        drawn = with_types(std::move(drawn), std::move(shortened.network), run);
    }
    diary.say(fmt::format("{}x{}, in equilibrium with {} cells of rivers", drawn.grid.width, drawn.grid.height,
                          rivers.channels.cell.size()));
    drawn.network = network::elevate_from_dem(drawn.network.plan, rivers.channels, land.dem);
    drawn.orders = network::order(drawn.network.plan);
    drawn.streams = network::count_streams(drawn.network.plan);
    drawn.valley = valley_of(rivers.channels, land.dem);
    drawn.channels = std::move(rivers.channels);
    drawn.surface.emplace();
    drawn.surface->dem = std::move(land.dem);
    return drawn;
}

DrawnTerrain with_side_valleys(DrawnTerrain drawn, flow::FlowField const& drainage, Diary& diary, Run const& run) {
    if (!drawn.recipe.network || !drawn.recipe.network->fill_space) {
        return drawn;
    }
    std::int64_t const support_cells = drawn.recipe.network->support_cells;
    network::SideValleys made = diary.stage("valleys", [&] {
        return network::side_valleys(drawn.network, drawn.channels, drawn.surface->dem, drainage, {support_cells}, run);
    });
    drawn.equilibrium->side_valleys = made.grown;
    drawn.equilibrium->side_valleys_left_out = made.left_out;
    diary.say(fmt::format("{} arcs that drain {} cells or more, besides {} of the input", made.grown, support_cells,
                          static_cast<std::int64_t>(made.network.plan.arc_count()) - made.grown));
    drawn.network = std::move(made.network);
    // Lengths at which each is kept.
    StreamNetwork kept = network::prune(drawn.network.plan, {0.0, drawn.grid.cell_m}, run).network;
    drawn = with_types(std::move(drawn), std::move(kept), run);
    drawn.orders = network::order(drawn.network.plan);
    drawn.streams = network::count_streams(drawn.network.plan);
    for (ArcId a = 0; a < drawn.network.plan.arc_count(); ++a) {
        Arc const& of = drawn.network.plan.arc(a);
        bool const leaves = drawn.network.plan.out(drawn.network.plan.to(a)) == no_arc;
        for (std::size_t v = 0; !of.is_input && v + (leaves ? 0 : 1) < of.line.size();
             ++v) { // the last may join a line
            std::int64_t const cell = drawn.grid.index(drawn.grid.cell_of(of.line[v]));
            drawn.valley.z[cell] = drawn.surface->dem[cell];
        }
    }
    return drawn;
}

} // namespace thalweg::pipeline
