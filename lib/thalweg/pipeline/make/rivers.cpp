// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/rivers.hpp>

#include <thalweg/network/vectorise/rasterise.hpp>
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

RaisedRivers raise_rivers(Plan const& plan, Planform const& planform, StageLog& stage_log, Run const& run) {
    Elevated raised = stage_log.stage("raise", [&] { return elevated(plan, planform, run); });
    network::Rasterised cells = network::rasterise(raised.network, planform.grid);
    return {std::move(raised.network), std::move(cells.valley),
            HeightsStatistics{raised.repair, cells.lowered_cells, cells.max_lowered_m}, std::move(raised.areas)};
}

} // namespace thalweg::pipeline
