// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/terrain.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/result_cache.hpp>
#include <thalweg/core/run/stage_log.hpp>
#include <thalweg/make/blend_into.hpp>
#include <thalweg/make/internal/ground.hpp>
#include <thalweg/make/internal/planform.hpp>
#include <thalweg/make/internal/raise_rivers.hpp>
#include <thalweg/make/river_claims.hpp>
#include <thalweg/network/channels/side_valleys.hpp>
#include <thalweg/network/vectorise/prune.hpp>
#include <thalweg/recipe/check_recipe.hpp>
#include <thalweg/recipe/frame.hpp>
#include <thalweg/recipe/recipe_files.hpp>
#include <thalweg/recipe/stage_recipes.hpp>
#include <thalweg/recipe/stages.hpp>

namespace thalweg::make {
namespace {

/// A surface before patches and drainage.
Surface undrained(SurfaceInput const& from, std::optional<Grid> const& planned, Run const& run) {
    recipe::Recipe const& recipe = from.recipe;
    bool const has_rivers = recipe.network.has_value();
    Grid const& fine = has_rivers ? from.planform.grid : *planned;
    StageLog stage_log(run);
    if (!has_rivers) {
        stage_log.find(require_targets(recipe, fine));
    } else if (!planned) { // else it was checked before the rivers were grown
        recipe::check_detail(recipe, fine.width, fine.height);
        recipe::require_skeleton_on_grid(recipe, from.points, from.ridges, fine);
    }
    RaisedRivers const raised = recipe::stage::raise.runs(recipe)
                                    ? raise_rivers(recipe, from.raster, from.planform, stage_log, run)
                                    : RaisedRivers{};
    Grid const grid = has_rivers ? fine : recipe::coarse_grid(fine, recipe::levels_of(recipe));
    GroundInput const in{from, grid, fine, raised};
    Surface surface = refined(ground_of(recipe)(in, run), in, run);
    stage_log.find(surface.notes.findings);
    stage_log.add(surface.notes.timings_s);
    surface.notes.findings = stage_log.take_findings();
    surface.notes.timings_s = stage_log.take();
    return surface;
}

/// The same, kept for the next terrain that is made from it.
Surface drawn(TerrainInput const& in, Run const& run) {
    return cached(
        run, "surface", [&] { return recipe::cache_key(in.surface.recipe); },
        [&] { return undrained(in.surface, in.grid, run); },
        [](Surface const& made) {
            constexpr std::int64_t of_cell = 16; // heights, rivers, levels
            return of_cell * made.ground.dem.cells();
        });
}

void show(Raster<float> const& dem, bool is_finished, Run const& run) {
    if (run.preview) {
        run.preview(dem, is_finished);
    }
}

BlendIntoParams params_of(recipe::Recipe const& recipe, recipe::PatchRecipe const& patch) {
    BlendIntoParams params;
    params.target = "the land";
    params.source = recipe::file_in(recipe, patch.source);
    params.mask = recipe::file_in(recipe, patch.mask);
    if (patch.at) {
        params.at = Vec2{(*patch.at)[0], (*patch.at)[1]};
    }
    if (patch.window) {
        auto const cells = [&](std::size_t i) { return static_cast<std::int64_t>((*patch.window)[i]); };
        params.window = blend::SourceWindow{cells(0), cells(1), cells(2), cells(3)};
    }
    params.rotate_deg = patch.rotate_deg;
    params.scale = patch.scale;
    params.gain = patch.gain;
    params.feather_cells = patch.feather_cells;
    return params;
}

/// Cells in which rivers end inland, where the recipe keeps these ends.
std::vector<CellIndex> sinks_of(recipe::Recipe const& recipe, Raster<float> const& dem, StreamNetwork const& network) {
    bool const sinks = recipe.network && recipe.network->inland == recipe::InlandEnds::sink;
    return sinks ? cells_of(inland_ends(network, dem), network, dem.grid()) : std::vector<CellIndex>{};
}

/// A surface with the recipe's patches, in their order; rivers keep their cells' heights unless a patch says otherwise.
Surface with_patches(Surface surface, recipe::Recipe const& recipe, StageLog& stage_log, Run const& run) {
    Ground& ground = surface.ground;
    ValleyCells& valley = surface.bed.valley;
    for (recipe::PatchRecipe const& patch : recipe.patches) {
        bool const keeps = patch.rivers == recipe::PatchRivers::keep && recipe.network.has_value();
        BlendedDem made = stage_log.stage(recipe::stage::blend.name, [&] {
            return blend_into(ground.dem, keeps ? river_mask(valley) : Mask{}, params_of(recipe, patch), run);
        });
        stage_log.find(made.findings);
        ground.dem = std::move(made.pasted.dem);
        ground.patches.push_back({made.pasted.cells, made.pasted.kept, made.pasted.seam_max_m, made.pasted.seam_rms_m});
        stage_log.say(
            fmt::format("{} cells of {}, seam {:.2g} m", made.pasted.cells, patch.source, made.pasted.seam_rms_m));
    }
    if (recipe.network && replaces_rivers(recipe)) {
        valley = honoured_valley(valley, surface.rivers.network.planform, ground.dem);
    }
    return surface;
}

/// A surface after hydrological conditioning, where the recipe asks for it.
struct ConditionedDem {
    Raster<float> dem;
    bool is_conditioned = false;
    flow::DemChange banks = {};
    flow::DemChange depressions = {};
};

/// Conditions a surface. Water leaves the land in sinks: meanwhile they are holes in it.
ConditionedDem conditioned(recipe::Recipe const& recipe, Raster<float> dem, ValleyCells const& rivers,
                           StreamNetwork const& network, StageLog& stage_log, Run const& run) {
    if (!recipe::stage::carve.runs(recipe)) {
        return {std::move(dem)};
    }
    constexpr float hole = std::numeric_limits<float>::quiet_NaN();
    std::vector<CellIndex> const sinks = sinks_of(recipe, dem, network);
    Valley valley{recipe.network ? rivers.raster() : Raster<float>(dem.grid(), hole)};
    std::vector<float> heights;
    for (CellIndex const sink : sinks) {
        heights.push_back(std::exchange(dem[sink], hole));
        valley.z[sink] = hole;
    }
    flow::ConditionedDem result = stage_log.stage(recipe::stage::carve.name, [&] {
        return flow::condition(std::move(dem), valley, {*recipe.surface->drain}, run);
    });
    Grid const grid = result.dem.grid();
    for (std::size_t i = 0; i < sinks.size(); ++i) {
        float lowest = std::numeric_limits<float>::infinity();
        for (Cell const step : d8_steps) {
            Cell const c{grid.at(sinks[i]).col + step.col, grid.at(sinks[i]).row + step.row};
            lowest = grid.contains(c) ? std::fmin(lowest, result.dem[c]) : lowest;
        }
        result.dem[sinks[i]] = std::min(heights[i], std::nextafterf(lowest, -std::numeric_limits<float>::infinity()));
    }
    stage_log.say(fmt::format("banks raised {:.0f} m3; depressions filled {:.0f} m3, cut {:.0f} m3",
                              result.banks.raised_m3, result.depressions.raised_m3, result.depressions.cut_m3));
    return {std::move(result.dem), true, result.banks, result.depressions};
}

flow::FlowField drainage_of(recipe::Recipe const& recipe, Raster<float> const& dem, StreamNetwork const& network,
                            StageLog& stage_log, Run const& run) {
    run.at(0.0, fmt::format("drain {} cells", dem.cells()).c_str());
    return stage_log.stage(recipe::stage::drain.name,
                           [&] { return flow::route(dem, sinks_of(recipe, dem, network), run); });
}

/// Rivers in their cells.
struct RiversInBed {
    Rivers rivers;
    RiverBed bed;
};

/// Rivers with the side valleys of a surface in equilibrium as arcs.
/// dem, drainage: the surface as it drains
RiversInBed with_side_valleys(RiversInBed made, recipe::NetworkRecipe const& wanted, Raster<float> const& dem,
                              flow::FlowField const& drainage, StageLog& stage_log, Run const& run) {
    network::SideValleys found = stage_log.stage(recipe::stage::valleys.name, [&] {
        return network::side_valleys(made.rivers.network, made.bed.channels, dem, drainage, {wanted.support_cells},
                                     run);
    });
    ElevatedNetwork network = std::move(found.network);
    stage_log.say(fmt::format("{} arcs that drain {} cells or more, besides {} of the input", found.grown,
                              wanted.support_cells,
                              static_cast<std::int64_t>(network.planform.arc_count()) - found.grown));
    Grid const& grid = dem.grid();
    // Lengths at which each is kept.
    TypedNetwork typed = type_rivers(network::prune(network.planform, {0.0, grid.cell_m}, run).network, wanted, run);
    network.planform = std::move(typed.network);
    std::vector<std::pair<CellIndex, float>> heights;
    for (std::size_t i = 0; i < made.bed.valley.cell.size(); ++i) {
        heights.emplace_back(made.bed.valley.cell[i], made.bed.valley.z[i]);
    }
    for (ArcId a = 0; a < network.planform.arc_count(); ++a) {
        Arc const& of = network.planform.arc(a);
        bool const leaves = network.planform.out(network.planform.to(a)) == no_arc;
        for (std::size_t v = 0; !of.is_input && v + (leaves ? 0 : 1) < of.line.size();
             ++v) { // the last may join a line
            std::int64_t const cell = grid.index(grid.cell_of(of.line[v]));
            heights.emplace_back(cell, dem[cell]);
        }
    }
    made.bed.valley = valley_cells(grid, std::move(heights));
    made.bed.grown = found.grown;
    made.bed.left_out = found.left_out;
    made.rivers = rivers_of(std::move(network), std::move(typed.types), std::move(made.rivers.clues));
    return made;
}

Terrain terrain_with_surface(TerrainInput const& in, Run const& run) {
    recipe::Recipe const& recipe = in.recipe;
    Planform const& planform = in.surface.planform;
    bool const has_rivers = recipe.network.has_value();
    StageLog stage_log(run);
    if (!has_rivers) { // else they are among the rivers' findings
        stage_log.find(recipe::conversions(recipe, *in.grid, run));
    }
    Surface surface = drawn(in, run);
    stage_log.add(surface.notes.timings_s);
    stage_log.find(surface.notes.findings);
    if (surface.ground.equilibrium() == nullptr) { // in equilibrium it was seen, and drains as it is
        show(surface.ground.dem, false, run);
    }
    surface = with_patches(std::move(surface), recipe, stage_log, run);
    StreamNetwork const& network = surface.rivers.network.planform;
    ConditionedDem drained =
        conditioned(recipe, std::move(surface.ground.dem), surface.bed.valley, network, stage_log, run);
    show(drained.dem, true, run);
    flow::FlowField drainage = drainage_of(recipe, drained.dem, network, stage_log, run);
    RiversInBed made{std::move(surface.rivers), std::move(surface.bed)};
    if (recipe::stage::valleys.runs(recipe)) {
        made = with_side_valleys(std::move(made), *recipe.network, drained.dem, drainage, stage_log, run);
    }
    flow::ContributingAreas areas =
        has_rivers ? flow::areas_d8(made.rivers.network.planform, drainage, run) : flow::ContributingAreas{};
    Ground ground = std::move(surface.ground);
    ground.dem = std::move(drained.dem);
    ground.land = recipe::on_raster(recipe) ? Mask{} : planform.land; // what has no data need not be sea
    return {
        .grid = has_rivers ? planform.grid : *in.grid,
        .ground = std::move(ground),
        .rivers = std::move(made.rivers),
        .bed = std::move(made.bed),
        .water = {std::move(drainage), std::move(areas), drained.is_conditioned, drained.banks, drained.depressions},
        .notes = {std::move(surface.notes.checks), stage_log.take_findings(), stage_log.take()}};
}

/// Rivers that have heights of their own, where the recipe asks for no surface.
Terrain rivers_alone(TerrainInput const& in, Run const& run) {
    Planform const& planform = in.surface.planform;
    StageLog stage_log(run);
    RaisedRivers raised = raise_rivers(in.recipe, in.surface.raster, planform, stage_log, run);
    Terrain terrain;
    terrain.grid = planform.grid;
    terrain.ground.land = planform.land;
    terrain.rivers = rivers_of(std::move(raised.network), planform.types, planform.file.clues);
    terrain.bed.valley = std::move(raised.valley);
    terrain.bed.heights = raised.statistics;
    terrain.water.areas =
        raised.areas ? std::move(*raised.areas) : flow::areas_nearest(planform.network, planform.grid, run);
    terrain.notes.findings = std::move(raised.findings);
    terrain.notes.timings_s = stage_log.take();
    return terrain;
}

} // namespace

Terrain draw_terrain(TerrainInput const& in, Run const& run) {
    bool const rivers_only = in.recipe.network && !in.recipe.surface;
    Terrain terrain = rivers_only ? rivers_alone(in, run) : terrain_with_surface(in, run);
    run.report(terrain.notes.findings);
    return terrain;
}

} // namespace thalweg::make
