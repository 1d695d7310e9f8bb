// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/internal/water.hpp>

#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/make/blend_into.hpp>
#include <thalweg/make/internal/planform.hpp>
#include <thalweg/make/river_claims.hpp>
#include <thalweg/network/channels/side_valleys.hpp>
#include <thalweg/network/vectorise/prune.hpp>
#include <thalweg/recipe/check_recipe.hpp>
#include <thalweg/recipe/recipe_files.hpp>
#include <thalweg/recipe/stages.hpp>

namespace thalweg::make {
namespace {

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

} // namespace

Surface with_patches(Surface surface, recipe::Recipe const& recipe, StageLog& stage_log, Run const& run) {
    Ground& ground = surface.ground;
    Valley& valley = surface.bed.valley;
    for (recipe::PatchRecipe const& patch : recipe.patches) {
        bool const keeps = patch.rivers == recipe::PatchRivers::keep && recipe.network.has_value();
        BlendedDem made = stage_log.stage("blend", [&] {
            return blend_into(ground.dem, keeps ? river_mask(valley) : Mask{}, params_of(recipe, patch), run);
        });
        stage_log.find(made.findings);
        ground.dem = std::move(made.pasted.dem);
        ground.patches.push_back({made.pasted.cells, made.pasted.kept, made.pasted.seam_max_m, made.pasted.seam_rms_m});
        stage_log.say(
            fmt::format("{} cells of {}, seam {:.2g} m", made.pasted.cells, patch.source, made.pasted.seam_rms_m));
    }
    if (recipe.network && replaces_rivers(recipe)) {
        valley = honoured_valley(std::move(valley), surface.rivers.network.planform, ground.dem);
    }
    return surface;
}

Conditioned conditioned(recipe::Recipe const& recipe, Raster<float> dem, Valley valley, StreamNetwork const& network,
                        StageLog& stage_log, Run const& run) {
    if (!conditions_dem(recipe)) {
        return {std::move(dem)};
    }
    constexpr float hole = std::numeric_limits<float>::quiet_NaN();
    if (!recipe.network) {
        valley.z = Raster<float>(dem.grid(), hole);
    }
    std::vector<CellIndex> const sinks = sinks_of(recipe, dem, network);
    std::vector<float> heights;
    for (CellIndex const sink : sinks) {
        heights.push_back(std::exchange(dem[sink], hole));
        valley.z[sink] = hole;
    }
    flow::ConditionedDem result = stage_log.stage(
        "carve", [&] { return flow::condition(std::move(dem), valley, {*recipe.surface->drain}, run); });
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
    return stage_log.stage("drain", [&] { return flow::route(dem, sinks_of(recipe, dem, network), run); });
}

RiversInBed with_side_valleys(RiversInBed made, recipe::NetworkRecipe const& wanted, Raster<float> const& dem,
                              flow::FlowField const& drainage, StageLog& stage_log, Run const& run) {
    network::SideValleys found = stage_log.stage("valleys", [&] {
        return network::side_valleys(made.rivers.network, made.bed.channels, dem, drainage, {wanted.support_cells},
                                     run);
    });
    ElevatedNetwork network = std::move(found.network);
    stage_log.say(fmt::format("{} arcs that drain {} cells or more, besides {} of the input", found.grown,
                              wanted.support_cells,
                              static_cast<std::int64_t>(network.planform.arc_count()) - found.grown));
    Grid const& grid = dem.grid();
    // Lengths at which each is kept.
    Typed typed = type_rivers(network::prune(network.planform, {0.0, grid.cell_m}, run).network, wanted, run);
    network.planform = std::move(typed.network);
    for (ArcId a = 0; a < network.planform.arc_count(); ++a) {
        Arc const& of = network.planform.arc(a);
        bool const leaves = network.planform.out(network.planform.to(a)) == no_arc;
        for (std::size_t v = 0; !of.is_input && v + (leaves ? 0 : 1) < of.line.size();
             ++v) { // the last may join a line
            std::int64_t const cell = grid.index(grid.cell_of(of.line[v]));
            made.bed.valley.z[cell] = dem[cell];
        }
    }
    made.bed.grown = found.grown;
    made.bed.left_out = found.left_out;
    made.rivers = rivers_of(std::move(network), std::move(typed.types), std::move(made.rivers.clues));
    return made;
}

} // namespace thalweg::make
