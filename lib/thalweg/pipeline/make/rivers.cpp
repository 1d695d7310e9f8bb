// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/internal/rivers.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/measure/drainage/drainage.hpp>
#include <thalweg/network/elevation/keep_heights.hpp>
#include <thalweg/network/elevation/set_heights_graded.hpp>
#include <thalweg/network/import/land_and_sea.hpp>
#include <thalweg/network/order/count_streams.hpp>
#include <thalweg/network/order/order.hpp>
#include <thalweg/network/planform/carry_outlets.hpp>
#include <thalweg/network/planform/meander.hpp>
#include <thalweg/network/vectorise/cut_corners.hpp>
#include <thalweg/network/vectorise/prune.hpp>
#include <thalweg/network/vectorise/rasterise.hpp>
#include <thalweg/pipeline/make/internal/land_in_equilibrium.hpp>
#include <thalweg/pipeline/make/internal/plan_rivers.hpp>
#include <thalweg/pipeline/recipe/internal/conversions.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_files.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace thalweg::pipeline {

namespace {

RaisedNetwork raise(Planned const& planned, Terrain& terrain, Run const& run) {
    NetworkRecipe const& wanted = *terrain.recipe.network;
    if (planned.file_heights) {
        return network::keep_heights(planned.plan, *planned.file_heights, wanted.slope);
    }
    if (wanted.heights == Heights::rosgen) {
        return network::set_heights_by_type(planned.plan, terrain.types, {wanted.rosgen_slope, terrain.recipe.seed},
                                            run);
    }
    if (wanted.heights == Heights::graded) {
        measure::ContributingAreas const areas = measure::areas_nearest(planned.plan, terrain.grid, run);
        double const cell = terrain.grid.cell_m * terrain.grid.cell_m;
        return network::set_heights_graded(planned.plan, areas.us_area_m2, areas.ds_area_m2,
                                           {wanted.slope, wanted.concavity, cell}, run)
            .network;
    }
    network::HeightMode const mode = wanted.heights == Heights::straight       ? network::HeightMode::straight
                                     : wanted.heights == Heights::along_stream ? network::HeightMode::along_stream
                                                                               : network::HeightMode::straight_repaired;
    network::Raised raised = network::set_heights(planned.plan, {mode, wanted.slope}, run);
    terrain.story.heights = raised.report;
    return std::move(raised.network);
}

/// Bends rivers, where the recipe wants it, once it is said how much. Those that end on a coast stay as they grew, in
/// all directions alike: bent ones would leave the land.
void let_wander(Planned& planned, Terrain& terrain, Diary& diary, Run const& run) {
    NetworkRecipe& rivers = *terrain.recipe.network;
    bool const has_coast = !terrain.land.values().empty();
    bool const grown_for_land = rivers.source != Source::lines && in_equilibrium(terrain.recipe) && !has_coast;
    rivers.meander = rivers.meander.value_or(grown_for_land ? 1.0 : 0.0);
    if (*rivers.meander == 0.0 && !grown_for_land) {
        return;
    }
    if (has_coast) {
        throw BadParameter("network.meander cannot bend rivers that end on a coast; leave it out");
    }
    if (planned.file_heights) {
        throw BadParameter("network.meander cannot bend rivers whose heights come from their file; set "
                           "network.heights = \"graded\" or leave meander out");
    }
    measure::ContributingAreas const areas = measure::areas_nearest(planned.plan, terrain.grid, run);
    network::MeanderParams const params{.gain = *rivers.meander, .seed = terrain.recipe.seed};
    network::Meandered bent = diary.stage("meander", [&] {
        return terrain.land.cells() > 0 ? network::meander(planned.plan, terrain.land, areas.ds_area_m2, params, run)
                                        : network::meander(planned.plan, terrain.grid, areas.ds_area_m2, params, run);
    });
    diary.say(fmt::format("{} vertices, at most {:.0f} m aside", bent.vertices, bent.max_shift_m));
    terrain.sources = terrain.sources.bent(planned.plan, bent.network);
    planned.plan = std::move(bent.network);
}

/// A word where outlets went far over ground of which the file says nothing.
void warn_of_long_ways(std::vector<Finding> const& notes, StreamNetwork const& plan, Run const& run) {
    constexpr std::int64_t many = 3;
    constexpr double much = 0.1; // of the length of all rivers
    double carried_m = 0.0;
    std::int64_t outlets = 0;
    for (Finding const& note : notes) {
        if (note.kind == "carried_outlet" || note.kind == "joined_outlet") {
            carried_m += note.amount;
            ++outlets;
        }
    }
    double length_m = 0.0;
    for (ArcId arc = 0; arc < plan.arc_count(); ++arc) {
        length_m += length_of(plan.arc(arc).line);
    }
    if (outlets >= many && carried_m > much * length_m) {
        run.say(fmt::format("warning: {} rivers end inside the grid and were extended by {:.3g} km in all, by the "
                            "shortest ways. If they end at the sea: --set network.inland=coast.",
                            outlets, carried_m / 1000.0));
    }
}

/// Outlets inside the grid: carried to where rivers may end, where the recipe wants it. Those at the sea reach it in
/// any case; what lies beside a river is land.
void carry_outlets(StreamNetwork& plan, bool join, Terrain& terrain, Run const& run) {
    constexpr std::int64_t at_sea_cells = 4;
    bool const all = terrain.recipe.network->inland != InlandEnds::sink;
    auto const take = [&](network::Carried carried) {
        warn_of_long_ways(carried.notes, plan, run);
        terrain.story.repairs.insert(terrain.story.repairs.end(), carried.notes.begin(), carried.notes.end());
        plan = std::move(carried.network);
    };
    if (terrain.land.cells() == 0 && terrain.recipe.network->inland == InlandEnds::coast) {
        terrain.land = network::land_behind_outlets(plan, terrain.grid, run);
    }
    if (terrain.land.cells() == 0) {
        if (all) {
            take(network::carry_outlets(plan, terrain.grid, {.join = join}));
        }
        return;
    }
    // A river that is carried may close the way of another.
    for (std::size_t moved = 1, rounds = 0; moved > 0 && rounds < 4; ++rounds) {
        terrain.land = network::land_along_rivers(std::move(terrain.land), plan);
        network::Carried carried =
            network::carry_outlets(plan, terrain.land, all ? terrain.grid.cells() : at_sea_cells, {.join = join});
        moved =
            static_cast<std::size_t>(std::count_if(carried.notes.begin(), carried.notes.end(), [](Finding const& f) {
                return f.kind == "carried_outlet" || f.kind == "joined_outlet";
            }));
        take(std::move(carried));
    }
    terrain.land = network::land_along_rivers(std::move(terrain.land), plan);
}

std::size_t vertices_of(StreamNetwork const& plan) {
    std::size_t count = 0;
    for (ArcId arc = 0; arc < plan.arc_count(); ++arc) {
        count += plan.arc(arc).line.size();
    }
    return count;
}

/// Rivers that run from cell to cell keep no corner where a branch was; what that shortens is measured again.
network::Pruned prune(StreamNetwork const& plan, NetworkRecipe const& rivers, double length_cells, double cell_m,
                      Run const& run) {
    network::Pruned pruned = network::prune(plan, {length_cells, cell_m}, run);
    if (rivers.source != Source::dla && rivers.source != Source::forest) {
        return pruned;
    }
    for (std::size_t before = 0, now = vertices_of(pruned.network); now != before;) {
        StreamNetwork cut = network::cut_corners(std::move(pruned.network), cell_m, run);
        before = now;
        now = vertices_of(cut);
        pruned.network = network::prune(cut, {length_cells, cell_m}, run).network;
    }
    return pruned;
}

Planned plan(Recipe& recipe, Terrain& terrain, Diary& diary, Run const& run) {
    switch (recipe.network->source) {
    case Source::dla: return plan_dla(recipe, terrain, diary, run);
    case Source::tokunaga: return plan_tokunaga(recipe, terrain, diary, run);
    case Source::forest: return plan_forest(recipe, terrain, diary, run);
    case Source::lines: break;
    }
    return plan_lines(recipe, terrain, diary, run);
}

} // namespace

void assign_types(StreamNetwork& plan, Terrain& terrain, Run const& run) {
    NetworkRecipe const& wanted = *terrain.recipe.network;
    if (wanted.heights != Heights::rosgen && !(wanted.coast_m > 0.0)) {
        return;
    }
    network::AssignTypesParams params;
    params.choice = wanted.rosgen ? network::TypeChoice::one : network::TypeChoice::by_order;
    params.one = wanted.rosgen.value_or(params.one);
    params.coast_m = wanted.coast_m;
    terrain.types = network::assign_types(plan, network::order(plan), params, run);
    NetworkDraft typed = plan.draft();
    for (ArcId a = 0; a < typed.arcs.size(); ++a) {
        typed.arcs[a].arc.type = network::name_of(terrain.types.type[a]);
    }
    plan = std::move(typed);
}

void make_rivers(Terrain& terrain, Diary& diary, Run const& run) {
    Recipe& recipe = terrain.recipe;
    NetworkRecipe& rivers = *recipe.network;
    Planned planned = plan(recipe, terrain, diary, run);
    take_frame(terrain, planned.grid);
    report_conversions(terrain, run);
    Grid const& grid = terrain.grid;
    if (rivers.heights == Heights::automatic) {
        rivers.heights = in_equilibrium(recipe) ? Heights::graded : Heights::straight_repaired;
    }
    if (!rivers.prune_cells) {
        bool const all_over = rivers.source == Source::dla || rivers.source == Source::forest;
        rivers.prune_cells = all_over ? 20.0 : 0.0;
    }

    network::Pruned pruned =
        diary.stage("prune", [&] { return prune(planned.plan, rivers, *rivers.prune_cells, grid.cell_m, run); });
    terrain.story.arcs_traced = pruned.arcs_before;
    terrain.story.arcs_kept = static_cast<std::int64_t>(pruned.network.arc_count());
    diary.say(
        fmt::format("L={}   {} of {} arcs kept", *rivers.prune_cells, terrain.story.arcs_kept, pruned.arcs_before));
    std::vector<Finding>& repairs = terrain.story.repairs;
    if (rivers.source == Source::forest) { // its rivers end where the land does
        std::vector<Finding> const gone = pruned_outlets(planned.plan, pruned.network);
        repairs.insert(repairs.end(), gone.begin(), gone.end());
    }
    terrain.land = std::move(planned.land);
    planned.plan = std::move(pruned.network);
    if (rivers.source != Source::forest) {
        carry_outlets(planned.plan, !planned.file_heights, terrain, run); // given heights may not fall into another's
    }

    let_wander(planned, terrain, diary, run);

    assign_types(planned.plan, terrain, run);
    if (in_equilibrium(recipe) && rivers.heights == Heights::graded) { // their heights are the land's
        terrain.network.plan = std::move(planned.plan);
        return;
    }
    terrain.network = diary.stage("raise", [&] { return raise(planned, terrain, run); });
    terrain.orders = network::order(terrain.network.plan);
    terrain.streams = network::count_streams(terrain.network.plan);
    network::Rasterised rasterised = network::rasterise(terrain.network, grid);
    terrain.valley = std::move(rasterised.valley);
    terrain.story.lowered_cells = rasterised.lowered_cells;
    terrain.story.max_lowered_m = rasterised.max_lowered_m;
}

} // namespace thalweg::pipeline
