// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <thalweg/pipeline/make/internal/rivers.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/io/gdal/access.hpp>
#include <thalweg/network/elevation/known_heights.hpp>
#include <thalweg/network/import/land_and_sea.hpp>
#include <thalweg/network/planform/carry_outlets.hpp>
#include <thalweg/network/planform/meander.hpp>
#include <thalweg/network/vectorise/prune.hpp>
#include <thalweg/network/vectorise/rasterise.hpp>
#include <thalweg/pipeline/plan/internal/plan.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_files.hpp>

namespace thalweg::pipeline {

Typed type_rivers(StreamNetwork plan, NetworkRecipe const& wanted, Run const& run) {
    Typed typed{std::move(plan), {}};
    if (wanted.heights != Heights::rosgen && !(wanted.coast_m > 0.0)) {
        return typed;
    }
    network::AssignTypesParams params;
    params.choice = wanted.rosgen ? network::TypeChoice::one : network::TypeChoice::by_order;
    params.one = wanted.rosgen.value_or(params.one);
    params.coast_m = wanted.coast_m;
    typed.types = network::assign_types(typed.plan, network::order(typed.plan), params, run);
    NetworkDraft draft = typed.plan.draft();
    for (std::size_t a = 0; a < draft.arcs.size(); ++a) {
        draft.arcs[a].arc.type = network::name_of(typed.types.type[a]);
    }
    typed.plan = std::move(draft);
    return typed;
}

namespace {

struct Elevated {
    ElevatedNetwork network;
    network::HeightReport report = {}; ///< for methods that set heights
};

Elevated raise(Plan const& plan, RiversInPlan const& planned, network::RiverTypes const& types, Run const& run) {
    NetworkRecipe const& wanted = *plan.recipe.network;
    if (planned.file_heights) {
        return {network::keep_heights(planned.network, *planned.file_heights)};
    }
    if (wanted.heights == Heights::rosgen) {
        return {network::set_heights_by_type(planned.network, types, {wanted.rosgen_slope, plan.recipe.seed}, run)};
    }
    if (wanted.heights == Heights::graded) {
        flow::ContributingAreas const areas = flow::areas_nearest(planned.network, planned.grid, run);
        double const cell = planned.grid.cell_m * planned.grid.cell_m;
        return {network::set_heights_graded(planned.network, areas.us_area_m2, areas.ds_area_m2,
                                            {wanted.slope, wanted.concavity, cell}, run)
                    .network};
    }
    network::HeightMode const mode = wanted.heights == Heights::straight       ? network::HeightMode::straight
                                     : wanted.heights == Heights::along_stream ? network::HeightMode::along_stream
                                                                               : network::HeightMode::straight_repaired;
    network::Elevated raised = network::set_heights(planned.network, {mode, wanted.slope}, run);
    return {std::move(raised.network), raised.report};
}

/// Makes rivers meander, if the plan requests it; with a sea, none leaves the land.
RiversInPlan let_wander(Plan const& plan, RiversInPlan planned, Diary& diary, Run const& run) {
    if (!bends_rivers(plan)) {
        return planned;
    }
    refuse_if<BadParameter>(planned.file_heights.has_value(),
                            "network.meander cannot bend rivers whose heights come from their "
                            "file; set network.heights = \"graded\" or leave meander out");
    flow::ContributingAreas const areas = flow::areas_nearest(planned.network, planned.grid, run);
    network::MeanderParams const params{.gain = *plan.recipe.network->meander, .seed = plan.recipe.seed};
    network::Meandered bent = diary.stage("meander", [&] {
        return planned.land.cells() > 0
                   ? network::meander(planned.network, planned.land, areas.ds_area_m2, params, run)
                   : network::meander(planned.network, planned.grid, areas.ds_area_m2, params, run);
    });
    diary.say(fmt::format("{} vertices, at most {:.0f} m aside", bent.vertices, bent.max_shift_m));
    double const before_m = planned.file.sources.length_m(planned.network);
    planned.file.sources = planned.file.sources.bent(planned.network, bent.network);
    planned.file.lengthened = before_m > 0.0 ? planned.file.sources.length_m(bent.network) / before_m : 1.0;
    planned.file.adopted = bent.network;
    planned.network = std::move(bent.network);
    return planned;
}

/// Warns when outlets were extended far beyond the data.
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
        length_m += plan.length_m(arc);
    }
    if (outlets >= many && carried_m > much * length_m) {
        run.say(fmt::format("warning: {} rivers end inside the grid and were extended by {:.3g} km in all, by the "
                            "shortest ways. If they end at the sea: --set network.inland=coast.",
                            outlets, carried_m / 1000.0));
    }
}

/// Extends outlets inside the grid to where rivers may end, if the recipe requests it. Those at the sea reach it in any
/// case; cells beside a river are land.
RiversInPlan with_outlets_carried(Plan const& plan, RiversInPlan planned, Run const& run) {
    if (plan.recipe.network->source == Source::forest) {
        return planned; // its outlets lie on its coast
    }
    constexpr std::int64_t at_sea_cells = 4;
    InlandEnds const inland = plan.recipe.network->inland;
    bool const all = inland != InlandEnds::sink;
    // rivers with given heights must not join another one
    network::CarryParams const params{.join = !planned.file_heights};
    auto const take = [&](network::Carried carried) {
        warn_of_long_ways(carried.notes, planned.network, run);
        std::vector<Finding>& repairs = planned.story.repairs;
        repairs.insert(repairs.end(), carried.notes.begin(), carried.notes.end());
        planned.network = std::move(carried.network);
    };
    if (planned.land.cells() == 0 && inland == InlandEnds::coast) {
        planned.land = network::land_behind_outlets(planned.network, planned.grid, run);
    }
    if (planned.land.cells() == 0) {
        if (all) {
            take(network::carry_outlets(planned.network, planned.grid, params));
        }
        return planned;
    }
    // An extended river may block the path of another.
    for (std::size_t moved = 1, rounds = 0; moved > 0 && rounds < 4; ++rounds) {
        planned.land = network::land_along_rivers(std::move(planned.land), planned.network);
        network::Carried carried =
            network::carry_outlets(planned.network, planned.land, all ? planned.grid.cells() : at_sea_cells, params);
        moved =
            static_cast<std::size_t>(std::count_if(carried.notes.begin(), carried.notes.end(), [](Finding const& f) {
                return f.kind == "carried_outlet" || f.kind == "joined_outlet";
            }));
        take(std::move(carried));
    }
    planned.land = network::land_along_rivers(std::move(planned.land), planned.network);
    return planned;
}

std::size_t vertices_of(StreamNetwork const& plan) {
    std::size_t count = 0;
    for (ArcId arc = 0; arc < plan.arc_count(); ++arc) {
        count += plan.arc(arc).line.size();
    }
    return count;
}

/// Removes corners that removed branches leave in rivers drawn from cell to cell, and prunes again by the shortened
/// lengths.
network::Pruned prune(StreamNetwork const& plan, NetworkRecipe const& rivers, double length_cells, double cell_m,
                      Run const& run) {
    network::Pruned pruned = network::prune(plan, {length_cells * cell_m, cell_m}, run);
    if (rivers.source != Source::dla && rivers.source != Source::forest) {
        return pruned;
    }
    for (std::size_t before = 0, now = vertices_of(pruned.network); now != before;) {
        StreamNetwork cut = network::cut_corners(pruned.network, cell_m, run);
        before = now;
        now = vertices_of(cut);
        pruned.network = network::prune(cut, {length_cells * cell_m, cell_m}, run).network;
    }
    return pruned;
}

// A note for each outlet that pruning removed from a network.
std::vector<Finding> pruned_outlets(StreamNetwork const& before, StreamNetwork const& after) {
    auto const places = [](StreamNetwork const& network) {
        std::vector<Vec2> at;
        for (NodeId const n : network.outlets()) {
            at.push_back(network.node(n).at);
        }
        std::ranges::sort(at, [](Vec2 a, Vec2 b) { return a.y != b.y ? a.y > b.y : a.x < b.x; });
        return at;
    };
    std::vector<Vec2> const left = places(after);
    std::vector<Finding> notes;
    for (Vec2 const p : places(before)) {
        if (std::ranges::find(left, p) == left.end()) {
            notes.push_back({"pruned_outlet", 0, p, 0.0,
                             fmt::format("the river that ended at ({:.1f}, {:.1f}) was pruned away, its branches are "
                                         "all too short",
                                         p.x, p.y)});
        }
    }
    return notes;
}

/// Prunes short branches, if the recipe requests it.
RiversInPlan pruned(Plan const& plan, RiversInPlan planned, Diary& diary, Run const& run) {
    NetworkRecipe const& rivers = *plan.recipe.network;
    network::Pruned kept = diary.stage(
        "prune", [&] { return prune(planned.network, rivers, *rivers.prune_cells, planned.grid.cell_m, run); });
    NetworkStory& story = planned.story;
    story.arcs_traced = kept.arcs_before;
    story.arcs_kept = static_cast<std::int64_t>(kept.network.arc_count());
    diary.say(fmt::format("L={}   {} of {} arcs kept", *rivers.prune_cells, story.arcs_kept, kept.arcs_before));
    if (rivers.source == Source::forest) { // its rivers end at the border of the land
        std::vector<Finding> const gone = pruned_outlets(planned.network, kept.network);
        story.repairs.insert(story.repairs.end(), gone.begin(), gone.end());
    }
    append(planned.file.secondary,
           planned.file.sources.missing(planned.network, kept.network, LeftOut::pruned, "pruned"));
    planned.network = std::move(kept.network);
    planned.file.adopted = planned.network;
    return planned;
}

/// Adds a note on each conversion to the rivers' grid.
RiversInPlan with_conversions(Plan const& plan, RiversInPlan planned, Run const& run) {
    std::vector<Finding> const notes = report_conversions(plan.recipe, planned.grid, run);
    planned.story.repairs.insert(planned.story.repairs.end(), notes.begin(), notes.end());
    return planned;
}

/// Assigns types to rivers, and heights unless these follow from the terrain.
Rivers with_heights(Plan const& plan, RiversInPlan planned, Diary& diary, Run const& run) {
    Typed typed = type_rivers(std::move(planned.network), *plan.recipe.network, run);
    planned.network = std::move(typed.plan);
    Rivers rivers;
    rivers.grid = planned.grid;
    rivers.file = std::move(planned.file);
    rivers.land = std::move(planned.land);
    rivers.types = std::move(typed.types);
    rivers.story = std::move(planned.story);
    if (follows_land(plan.recipe)) {
        rivers.network.plan = std::move(planned.network);
        return rivers;
    }
    Elevated raised = diary.stage("raise", [&] { return raise(plan, planned, rivers.types, run); });
    network::Rasterised rasterised = network::rasterise(raised.network, planned.grid);
    rivers.story.heights = raised.report;
    rivers.story.lowered_cells = rasterised.lowered_cells;
    rivers.story.max_lowered_m = rasterised.max_lowered_m;
    rivers.network = std::move(raised.network);
    rivers.orders = network::order(rivers.network.plan);
    rivers.streams = network::count_streams(rivers.network.plan);
    rivers.valley = std::move(rasterised.valley);
    return rivers;
}

} // namespace

Rivers make_rivers(Plan const& plan, Run const& run) {
    if (!plan.recipe.network) {
        return {};
    }
    io::RecipeFiles const confined;
    Diary diary(run);
    RiversInPlan planned = rivers_in_plan(plan, diary, run);
    planned = with_conversions(plan, std::move(planned), run);
    planned = pruned(plan, std::move(planned), diary, run);
    planned = with_outlets_carried(plan, std::move(planned), run);
    planned = let_wander(plan, std::move(planned), diary, run);
    Rivers rivers = with_heights(plan, std::move(planned), diary, run);
    rivers.timings_s = diary.take();
    return rivers;
}

} // namespace thalweg::pipeline
