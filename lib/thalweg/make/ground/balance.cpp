// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/internal/balance.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <thalweg/make/internal/between_rivers.hpp>
#include <thalweg/make/internal/lakes.hpp>
#include <thalweg/make/internal/planform.hpp>
#include <thalweg/measure/relief/slopes.hpp>
#include <thalweg/measure/texture/texture.hpp>
#include <thalweg/network/channels/channels.hpp>
#include <thalweg/network/elevation/known_heights.hpp>
#include <thalweg/network/import/land_and_sea.hpp>
#include <thalweg/network/vectorise/rasterise.hpp>
#include <thalweg/recipe/condition.hpp>
#include <thalweg/recipe/read_inputs.hpp>
#include <thalweg/recipe/recipe_files.hpp>
#include <thalweg/recipe/stages.hpp>
#include <thalweg/skeleton/ridges.hpp>
#include <thalweg/surface/equilibrium/match_texture.hpp>
#include <thalweg/surface/uplift/uplift_pattern.hpp>

// Described in docs/equilibrium.md.

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

double higher(double a, double b) {
    return std::isnan(a) || b > a ? b : a;
}

/// The cells that points and ridges lie in: the highest point of a cell, else its highest ridge.
std::vector<surface::FeatureCell> feature_cells(FeaturePoints const& points, RiverLines const& ridges,
                                                Grid const& grid) {
    std::map<std::int64_t, surface::FeatureCell> cells;
    for (RiverLine const& ridge : ridges.lines) {
        for (skeleton::CellOfLine const& c : skeleton::cells_of_line(ridge.vertices, grid)) {
            surface::FeatureCell& cell = cells[c.cell];
            cell = {c.cell, static_cast<float>(higher(static_cast<double>(cell.z), c.z_m)), true};
        }
    }
    std::map<std::int64_t, double> heights;
    for (Vec3 const& p : points.points) {
        auto const [place, is_new] = heights.try_emplace(grid.index(grid.cell_of(in_plan(p))), p.z);
        place->second = std::max(place->second, p.z);
    }
    for (auto const& [cell, z_m] : heights) {
        cells[cell] = {cell, static_cast<float>(z_m), cells[cell].crest};
    }
    std::vector<surface::FeatureCell> out;
    for (auto const& [number, cell] : cells) {
        out.push_back(cell);
    }
    return out;
}

/// Land, uplift and erodibility of terrain in equilibrium: from the recipe's files and its pattern of uplift.
surface::EquilibriumFields equilibrium_fields(GroundInput const& in, Channels const& channels, Run const& run) {
    recipe::Recipe const& recipe = in.recipe;
    Grid const& grid = in.grid;
    recipe::SurfaceRecipe const& wanted = *recipe.surface;
    surface::EquilibriumFields fields;
    fields.land = land_of(recipe::read_mask_of_land(recipe::file_in(recipe, recipe.surface->mask), grid, run),
                          in.planform.land, channels);
    fields.uplift = relative_uplift(recipe, grid, run);
    fields.erodibility =
        recipe::read_field(recipe::file_in(recipe, wanted.equilibrium.erodibility), grid, "surface.erodibility", run);
    fields.features = feature_cells(in.points, in.ridges, grid);
    fields.strata = strata_of(recipe, grid);
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

surface::Edge edge_of(GroundInput const& in, Mask const& land, Channels const& channels) {
    if (in.recipe.surface->equilibrium.edge) {
        return *in.recipe.surface->equilibrium.edge;
    }
    if (in.gaps.cells() > 0 && !in.has_coastlines) {
        return network::gaps_are_sea(in.gaps, channels) ? surface::Edge::coast : surface::Edge::closed;
    }
    bool const by_coastlines = recipe::from_lines(in.recipe) && in.planform.land.cells() > 0;
    return by_coastlines ? surface::Edge::mainland : has_sea(land) ? surface::Edge::coast : surface::Edge::open;
}

/// The parameters of the terrain.
surface::EquilibriumParams params_of(recipe::Recipe const& recipe, std::optional<recipe::LikeDem> const& like,
                                     surface::Edge edge) {
    recipe::EquilibriumRecipe const& wanted = recipe.surface->equilibrium;
    constexpr double half_width_km = 0.2125; // of valley floors where 1 km² drains, for a floor_width of 1
    double const relief_m = recipe.surface->dilate.relief_m;
    surface::EquilibriumParams params;
    params.theta = recipe.network->concavity;
    params.heights = use_of(recipe.network->heights);
    params.bring_to_target = wanted.mean_slope_deg || like || relief_m > 0.0;
    if (relief_m > 0.0) {
        params.relief_m = relief_m;
    } else if (params.bring_to_target) {
        params.mean_slope_deg = wanted.mean_slope_deg ? *wanted.mean_slope_deg : like->mean_slope_deg;
    } else if (recipe::from_lines(recipe)) { // given heights have their own slope
        params.mean_slope_deg = recipe::usual_slope_deg(recipe.grid.cell_m);
    }
    if (relief_m <= 0.0) {
        params.steepness = wanted.steepness;
    }
    if (recipe.strata && !recipe.layers.empty()) {
        params.cap_share = recipe.strata->cap_share;
    }
    params.hillslope_m = wanted.hillslope_m > 0.0 ? wanted.hillslope_m : recipe.grid.cell_m;
    params.debris_area_m2 = wanted.debris_area_km2 * 1e6;
    params.floor_width_km = half_width_km * wanted.floor_width;
    params.roughness = wanted.roughness;
    params.longest_wave_m = wanted.longest_wave_m;
    params.grain = wanted.grain;
    params.strike_deg = wanted.strike_deg;
    bool const by_file = recipe::from_lines(recipe); // the file includes all rivers that enter
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
    if (((given || by_levels) && !params.bring_to_target) || surface.is_bounded) {
        return {};
    }
    if (params.cap_share) {
        double const off = std::fabs(surface.cap_share - *params.cap_share);
        if (off > allowed) {
            stage_log.find(
                {.kind = "target_missed",
                 .amount = surface.cap_share,
                 .text = fmt::format("strata.cap_share = {:.4g} is not reached: {:.4g} of the land lies at the "
                                     "cap rock or above it",
                                     *params.cap_share, surface.cap_share),
                 .key = "strata.cap_share",
                 .numbers = {{"asked", *params.cap_share, "1"}}});
        }
        return {{"cap_share_error", off, allowed, off <= allowed}};
    }
    double const error = std::fabs(surface.target_share - 1.0);
    if (error > allowed) {
        double const asked = params.relief_m ? *params.relief_m : params.mean_slope_deg;
        char const* const unit = params.relief_m ? "m" : "degrees";
        char const* const name = params.relief_m ? "relief" : "mean_slope";
        stage_log.find({.kind = "target_missed",
                        .amount = surface.target_share * asked,
                        .text = fmt::format("surface.{} = {:.6g} {} cannot be reached with the {}: it is {:.4g} {}",
                                            name, asked, unit,
                                            given       ? "heights of the rivers"
                                            : by_levels ? "levels of the lakes"
                                                        : "layers of rock",
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

/// Correlation of gradients at the distance at which the DEM of surface.like has it.
double correlation_of(Raster<float> const& dem, recipe::LikeDem const& like, Run const& run) {
    auto const lag = std::ranges::find(measure::texture_lags_m, like.lag_m) - measure::texture_lags_m.begin();
    return measure::gradient_texture(dem, {}, run).correlation.at(static_cast<std::size_t>(lag));
}

/// Solves, and again with another roughness until gradients are correlated as in the DEM of surface.like.
SolvedEquilibrium match_like(recipe::LikeDem const& like, surface::EquilibriumParams params,
                             std::function<SolvedEquilibrium(surface::EquilibriumParams const&)> const& solve,
                             Run const& run) {
    constexpr double worth_a_word = 0.03;
    SolvedEquilibrium solved = solve(params);
    LikeStatistics met{like.mean_slope_deg, like.correlation, like.lag_m, params.roughness, std::nan("")};
    if (std::isnan(like.correlation) || params.roughness != surface::EquilibriumParams{}.roughness) {
        solved.told.like = met;
        return solved;
    }
    surface::TextureMatch const match = surface::match_texture(
        {params.roughness, correlation_of(solved.land.dem, like, run)}, like.correlation, [&](double roughness) {
            params.roughness = roughness;
            solved = solve(params);
            return correlation_of(solved.land.dem, like, run);
        });
    met.roughness = match.roughness;
    met.correlation = match.correlation;
    solved.told.like = met;
    solved.findings.push_back(
        {.kind = "like",
         .amount = match.correlation,
         .text = fmt::format("with a roughness of {:.2g} gradients {:g} m apart are correlated by {:.2f} ({:.2f} in "
                             "the DEM)",
                             match.roughness, like.lag_m, match.correlation, like.correlation),
         .key = "surface.like",
         .numbers = {{"roughness", match.roughness}, {"lag", like.lag_m, "m"}, {"wanted", like.correlation, "1"}}});
    if (std::fabs(match.correlation - like.correlation) > worth_a_word) {
        solved.findings.push_back(
            {.kind = "texture_missed",
             .amount = match.correlation,
             .text = fmt::format("the texture of surface.like cannot be reached with surface.roughness alone: the "
                                 "terrain is {} than that DEM",
                                 match.correlation < like.correlation ? "rougher" : "smoother"),
             .key = "surface.like",
             .numbers = {{"wanted", like.correlation, "1"}}});
    }
    return solved;
}

/// Solves for the land.
SolvedEquilibrium solved_for(GroundInput const& in, Balance const& balance, Channels const& channels,
                             StageLog& stage_log, Run const& run) {
    surface::EquilibriumFields const fields = equilibrium_fields(in, channels, run);
    run.at(0.0, fmt::format("fill {} cells", in.grid.cells()).c_str());
    surface::EquilibriumParams const params = params_of(in.recipe, in.like, edge_of(in, fields.land, channels));
    if (balance.is_rebuilt && in.recipe.surface->equilibrium.edge == surface::Edge::open) {
        stage_log.find({.kind = "key_without_effect",
                        .text = "surface.edge = \"open\" is not used: around heights of a file the terrain ends at the "
                                "grid, and all water drains to the rivers",
                        .key = "surface.edge"});
    }
    auto const solve = [&](surface::EquilibriumParams const& with) { return balance.solve(channels, fields, with); };
    SolvedEquilibrium solved = stage_log.stage(recipe::stage::fill_in_equilibrium.name, [&] {
        return in.like ? match_like(*in.like, params, solve, run) : solve(params);
    });
    stage_log.find(solved.findings);
    return solved;
}

/// How the surface was made.
HowMade how_of(SolvedEquilibrium solved, Balance const& balance, std::int64_t channel_cells) {
    surface::EquilibriumTerrain& land = solved.land;
    Rebuilt how = std::move(solved.told);
    how.edge = solved.params.edge;
    how.channel_cells = channel_cells;
    how.shortened_cells = static_cast<std::int64_t>(land.shortened.size());
    how.graded_heads = land.graded_heads;
    how.walled_cells = static_cast<std::int64_t>(land.walled.size());
    how.max_lowered_m = land.max_lowered_m;
    how.p95_lowered_m = land.p95_lowered_m;
    how.rise = land.rise;
    how.steepness = land.steepness;
    how.strata_shift_m = land.strata_shift_m;
    how.held_back = land.held_back;
    how.in_region = land.in_region;
    how.inflows = std::move(land.inflows);
    return balance.is_rebuilt ? HowMade(std::move(how)) : HowMade(static_cast<Equilibrium&&>(how));
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

ValleyCells valley_of(Channels const& channels, Raster<float> const& dem) {
    std::vector<std::pair<CellIndex, float>> heights;
    heights.reserve(channels.cell.size());
    for (CellIndex const cell : channels.cell) {
        heights.emplace_back(cell, dem[cell]);
    }
    return valley_cells(dem.grid(), std::move(heights));
}

/// Notes that nothing says how high the land around rivers of a file is, and what its heights follow from.
void note_invented_heights(surface::EquilibriumTerrain const& land, surface::EquilibriumParams const& params,
                           std::string const& file, StageLog& stage_log) {
    std::string const by =
        land.is_bounded
            ? fmt::format(
                  "main stems have a normalised steepness of {:.3g} m^0.9 (surface.steepness), so that the mean "
                  "slope is {:.3g}° and not {:.3g}°",
                  land.steepness, land.target_share * params.mean_slope_deg, params.mean_slope_deg)
            : fmt::format("the mean slope is {:.3g}°", params.mean_slope_deg);
    stage_log.find({.kind = "heights_invented",
                    .amount = land.steepness,
                    .text = fmt::format("heights are invented, as {} has none: {}", file, by),
                    .key = "surface.relief",
                    .layer = file});
}

/// Checks of what the recipe asks of the surface, and warnings.
std::vector<Check> checks_of(GroundInput const& in, SolvedEquilibrium const& solved, Balance const& balance,
                             Channels const& channels, bool by_levels, StageLog& stage_log, Run const& run) {
    surface::EquilibriumTerrain const& land = solved.land;
    std::vector<Check> checks = target_checks(land, solved.params, by_levels, stage_log);
    bool const given = solved.params.heights != surface::RiverHeights::graded;
    if (given || by_levels || solved.params.heads == surface::Heads::kept) {
        char const* const remedy = given       ? R"(network.heights = "graded" or "soft" lets rivers follow it)"
                                   : by_levels ? "Levels of lakes nearer to the terrain need fewer"
                                               : "A smaller grid.cell gives slopes room between rivers";
        checks.push_back(wall_check(land, channels, remedy, stage_log));
    }
    if (balance.is_rebuilt) {
        bool const has_sea =
            solved.params.edge == surface::Edge::coast || solved.params.edge == surface::Edge::mainland;
        checks.push_back(valley_check(land.dem, channels, has_sea, stage_log, run));
    }
    warn_of_region(land, in.recipe.surface->equilibrium.region, stage_log);
    if (heights_are_invented(in.recipe)) {
        note_invented_heights(land, solved.params, in.recipe.network->lines.path, stage_log);
    }
    warn_of_heights(land.dem, balance.is_rebuilt, stage_log);
    return checks;
}

/// A place on the map from the grid's centre; none: the centre.
std::array<double, 2> from_centre(std::optional<std::array<double, 2>> const& at, Grid const& grid) {
    if (!at) {
        return {0.0, 0.0};
    }
    return {(*at)[0] - (grid.west + 0.5 * static_cast<double>(grid.width) * grid.cell_m),
            (*at)[1] - (grid.south() + 0.5 * static_cast<double>(grid.height) * grid.cell_m)};
}

} // namespace

bool heights_are_invented(recipe::Recipe const& recipe) {
    return recipe::from_lines(recipe) && recipe::in_equilibrium(recipe) &&
           recipe.network->heights == recipe::Heights::graded && recipe.surface->equilibrium.like.empty() &&
           !(recipe.surface->dilate.relief_m > 0.0);
}

surface::Strata strata_of(recipe::Recipe const& recipe, Grid const& grid) {
    surface::Strata strata;
    strata.layers = recipe.layers;
    strata.seed = recipe.seed;
    recipe::StrataRecipe const wanted = recipe.strata.value_or(recipe::StrataRecipe{});
    strata.repeats = wanted.repeat;
    strata.base_m = wanted.base_m;
    strata.dip_deg = wanted.dip_deg;
    strata.strike_deg = wanted.strike_deg.value_or(
        recipe.surface->equilibrium.strike_deg.value_or(surface::random_strike_deg(recipe.seed)));
    strata.folds = {wanted.fold_m, wanted.fold_wave_m, wanted.fold_axis_deg.value_or(strata.strike_deg),
                    wanted.plunge_deg};
    if (wanted.dome_m != 0.0) {
        auto const [east_m, north_m] = from_centre(wanted.dome_at, grid);
        strata.domes = {{east_m, north_m, wanted.dome_m, wanted.dome_radius_m}};
    }
    if (wanted.fault_m != 0.0) {
        auto const [east_m, north_m] = from_centre(wanted.fault_at, grid);
        strata.faults = {{east_m, north_m, wanted.fault_strike_deg.value_or(strata.strike_deg), wanted.fault_m}};
    }
    strata.undulation_m = wanted.undulation_m;
    strata.undulation_wave_m = wanted.undulation_wave_m;
    return strata;
}

bool has_layers(recipe::Recipe const& recipe, Ground const& ground) {
    return !recipe.layers.empty() && ground.equilibrium() != nullptr;
}

Raster<float> bed_of(recipe::Recipe const& recipe, Ground const& ground, Grid const& grid, Run const& run) {
    return surface::bed_heights(grid, strata_of(recipe, grid), ground.equilibrium()->strata_shift_m, run);
}

Raster<float> relative_uplift(recipe::Recipe const& recipe, Grid const& grid, Run const& run) {
    recipe::EquilibriumRecipe const& wanted = recipe.surface->equilibrium;
    Raster<float> of_file = recipe::read_field(recipe::file_in(recipe, wanted.uplift), grid, "surface.uplift", run);
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

Surface balanced(GroundInput const& in, Balance const& balance, Run const& run) {
    StageLog stage_log(run);
    recipe::NetworkRecipe const& wanted = *in.recipe.network;
    network::ChannelsParams drawing;
    drawing.look_cells = balance.is_rebuilt ? 0 : drawing.look_cells; // heights decide where water goes
    network::ChannelsOfArcs rivers = stage_log.stage(
        recipe::stage::channels.name, [&] { return network::channels(in.planform.network, in.grid, drawing, run); });
    stage_log.find(rivers.notes);
    if (wanted.heights != recipe::Heights::graded) {
        rivers.channels.z = asked_heights(in.rivers.network, rivers.channels, wanted.heights);
    }
    WithLakes flooded = with_lakes(in.recipe, in.planform, std::move(rivers), run);
    stage_log.find(flooded.notes);
    Surface made;
    made.bed.heights = in.rivers.statistics;
    made.bed.lakes = std::ssize(flooded.lakes);
    SolvedEquilibrium solved = solved_for(in, balance, flooded.rivers.channels, stage_log, run);
    if (flooded.by_levels) {
        stage_log.find(network::missed_levels(flooded.rivers.channels, flooded.lakes, solved.land.dem));
    }
    rivers = std::move(flooded.rivers);
    std::int64_t const channel_cells = std::ssize(rivers.channels.cell);
    made.notes.checks = checks_of(in, solved, balance, rivers.channels, flooded.by_levels, stage_log, run);
    TypedNetwork typed{in.planform.network, in.planform.types};
    if (!solved.land.shortened.empty()) {
        network::ShortenedChannels shortened = network::shorten(in.planform.network, rivers, solved.land.shortened);
        stage_log.find(shortened.notes);
        rivers = std::move(shortened.drawn);
        typed = type_rivers(std::move(shortened.network), wanted, run);
    }
    stage_log.say(fmt::format("{}x{}, in equilibrium with {} cells of rivers", in.grid.width, in.grid.height,
                              rivers.channels.cell.size()));
    Raster<float> dem = std::move(solved.land.dem);
    made.rivers = rivers_of(network::elevate_from_dem(typed.network, rivers.channels, dem), std::move(typed.types),
                            in.planform.file.clues);
    made.bed.valley = valley_of(rivers.channels, dem);
    made.bed.channels = std::move(rivers.channels);
    Ground& ground = made.ground;
    ground.how = how_of(std::move(solved), balance, channel_cells);
    ground.ridges = joined(ridges_between(in, made.rivers, stage_log, run), skeleton::ridges_on(in.ridges, dem));
    ground.tin = triangulated(in.recipe, made.rivers.network, ground.ridges, in.points, stage_log, run);
    ground.dem = std::move(dem);
    made.notes.findings = stage_log.take_findings();
    made.notes.timings_s = stage_log.take();
    return made;
}

} // namespace thalweg::make
