// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/rivers.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/network/channels/channels.hpp>
#include <thalweg/network/elevation/known_heights.hpp>
#include <thalweg/network/vectorise/rasterise.hpp>
#include <thalweg/pipeline/make/internal/river_claims.hpp>
#include <thalweg/pipeline/make/internal/terrain.hpp>
#include <thalweg/pipeline/plan/internal/plan.hpp>

namespace thalweg::pipeline {
namespace {

struct Elevated {
    ElevatedNetwork network;
    network::HeightReport repair = {};                 ///< under modes that set heights
    std::optional<flow::ContributingAreas> areas = {}; ///< as RaisedRivers
};

Elevated elevated(Plan const& plan, Planform const& planform, Run const& run) {
    NetworkRecipe const& wanted = *plan.recipe.network;
    if (planform.file_heights) {
        return {*planform.file_heights};
    }
    if (wanted.heights == Heights::rosgen) {
        return {network::set_heights_by_type(planform.network, planform.types, {wanted.rosgen_slope, plan.recipe.seed},
                                             run)};
    }
    if (wanted.heights == Heights::graded) {
        flow::ContributingAreas areas = flow::areas_nearest(planform.network, planform.grid, run);
        double const cell = planform.grid.cell_m * planform.grid.cell_m;
        network::Graded graded = network::set_heights_graded(planform.network, areas.us_area_m2, areas.ds_area_m2,
                                                             {wanted.slope, wanted.concavity, cell}, run);
        return {std::move(graded.network), {}, std::move(areas)};
    }
    network::HeightMode const mode = wanted.heights == Heights::straight       ? network::HeightMode::straight
                                     : wanted.heights == Heights::along_stream ? network::HeightMode::along_stream
                                                                               : network::HeightMode::straight_repaired;
    network::Elevated set = network::set_heights(planform.network, {mode, wanted.slope}, run);
    return {std::move(set.network), set.report};
}

} // namespace

Rivers rivers_of(ElevatedNetwork network, network::RiverTypes types) {
    NetworkOrders orders = network::order(network.planform);
    network::StreamCounts streams = network::count_streams(network.planform);
    return {std::move(network), std::move(types), std::move(orders), std::move(streams)};
}

namespace {

/// The heights of a DEM in the cells of rivers, cut until each cell lies below those upstream.
Valley bed_of(Channels const& channels, Raster<float> const& dem, std::string const& source) {
    constexpr float none = std::numeric_limits<float>::infinity();
    Valley valley{Raster<float>(dem.grid(), std::numeric_limits<float>::quiet_NaN())};
    std::vector<float> most(channels.cell.size(), none);
    for (std::size_t i = channels.cell.size(); i-- > 0;) { // donors before their receivers
        CellIndex const cell = channels.cell[i];
        if (std::isnan(dem[cell])) {
            Vec2 const at = dem.grid().centre(dem.grid().at(cell));
            throw BadInput(
                fmt::format("surface.source = \"{}\" has no height at ({:.1f}, {:.1f}), where a river runs: "
                            "set grid.clip = true, which cuts rivers where the DEM has no data, or fill the hole "
                            "(gdal_fillnodata.py)",
                            source, at.x, at.y));
        }
        float const z = std::min(dem[cell], most[i]);
        valley.z[cell] = z;
        if (channels.receiver[i] >= 0) {
            float& below = most[channels.receiver[i]];
            below = std::min(below, std::nextafterf(z, -none));
        }
    }
    return valley;
}

/// A valley in which each sink lies below the land around it.
Valley with_sinks_lowest(Valley valley, std::vector<CellIndex> const& sinks, Raster<float> const& dem) {
    Grid const& grid = dem.grid();
    for (CellIndex const sink : sinks) {
        for (Cell const step : d8_steps) {
            Cell const c{grid.at(sink).col + step.col, grid.at(sink).row + step.row};
            if (grid.contains(c) && std::isnan(valley.z[c]) && !(dem[c] > valley.z[sink])) {
                valley.z[sink] = std::nextafterf(dem[c], -std::numeric_limits<float>::infinity());
            }
        }
    }
    return valley;
}

/// Rivers in the cells of the DEM that is the terrain.
RaisedRivers laid_on_raster(Plan const& plan, Planform const& planform, Run const& run) {
    network::ChannelsOfArcs drawn = network::channels(planform.network, planform.grid, {}, run);
    RaisedRivers laid;
    laid.valley = bed_of(drawn.channels, plan.raster, plan.recipe.surface->source);
    if (plan.recipe.network->inland == InlandEnds::sink) {
        std::vector<NodeId> const sinks = inland_ends(planform.network, plan.raster);
        laid.valley =
            with_sinks_lowest(std::move(laid.valley), cells_of(sinks, planform.network, planform.grid), plan.raster);
    }
    Raster<float> cut = plan.raster;
    CellIndex deepest = 0;
    for (CellIndex const cell : drawn.channels.cell) {
        double const by_m = static_cast<double>(cut[cell]) - static_cast<double>(laid.valley.z[cell]);
        laid.statistics.lowered_cells += by_m > 0.0 ? 1 : 0;
        deepest = by_m > laid.statistics.max_lowered_m ? cell : deepest;
        laid.statistics.max_lowered_m = std::max(laid.statistics.max_lowered_m, by_m);
        cut[cell] = laid.valley.z[cell];
    }
    laid.network = network::elevate_from_dem(planform.network, drawn.channels, cut);
    laid.findings = std::move(drawn.notes);
    if (laid.statistics.max_lowered_m > plan.recipe.surface->max_cut_m) {
        Vec2 const at = planform.grid.centre(planform.grid.at(deepest));
        laid.findings.push_back(
            {.kind = "deep_cut",
             .where = at,
             .amount = laid.statistics.max_lowered_m,
             .text = fmt::format("rivers are cut into {} by up to {:.1f} m, at ({:.0f}, {:.0f})",
                                 plan.recipe.surface->source, laid.statistics.max_lowered_m, at.x, at.y),
             .key = "surface.max_cut"});
    }
    return laid;
}

} // namespace

RaisedRivers raise_rivers(Plan const& plan, Planform const& planform, StageLog& stage_log, Run const& run) {
    if (heights_follow_raster(plan.recipe)) {
        RaisedRivers laid = stage_log.stage("raise", [&] { return laid_on_raster(plan, planform, run); });
        stage_log.say(fmt::format("{} cells of rivers cut, by up to {:.3g} m", laid.statistics.lowered_cells,
                                  laid.statistics.max_lowered_m));
        return laid;
    }
    Elevated raised = stage_log.stage("raise", [&] { return elevated(plan, planform, run); });
    network::Rasterised cells = network::rasterise(raised.network, planform.grid);
    return {std::move(raised.network), std::move(cells.valley),
            HeightsStatistics{raised.repair, cells.lowered_cells, cells.max_lowered_m}, std::move(raised.areas)};
}

} // namespace thalweg::pipeline
