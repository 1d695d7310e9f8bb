// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/rivers.hpp>

#include <thalweg/core/error.hpp>
#include <thalweg/io/projection.hpp>
#include <thalweg/io/read_rivers.hpp>
#include <thalweg/measure/drainage.hpp>
#include <thalweg/network/carry_outlets.hpp>
#include <thalweg/network/clip_lines.hpp>
#include <thalweg/network/keep_heights.hpp>
#include <thalweg/network/order.hpp>
#include <thalweg/network/prune.hpp>
#include <thalweg/network/rasterise.hpp>
#include <thalweg/network/set_heights_graded.hpp>
#include <thalweg/network/thin.hpp>
#include <thalweg/network/trace.hpp>
#include <thalweg/pipeline/frame.hpp>
#include <thalweg/pipeline/recipe_files.hpp>

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace thalweg::pipeline {

namespace {

/// A network in plan on its grid, with the file's heights where lines carry them.
struct Planned {
    StreamNetwork plan;
    Grid grid;
    std::optional<RaisedNetwork> file_heights;
};

Planned grow(Recipe& recipe, Terrain& terrain, Diary& diary, Run const& run) {
    NetworkRecipe& wanted = *recipe.network;
    recipe.grid.crs = io::projected_crs(recipe.grid.crs.empty() ? "EPSG:32631" : recipe.grid.crs);
    if (recipe.grid.width > 0) {
        check_memory(recipe.grid.width, recipe.grid.height);
    }
    check_memory_of_cluster(wanted.dla.particles);
    wanted.dla.seed = recipe.seed;
    run.at(0.0, fmt::format("grow {} particles", wanted.dla.particles).c_str());
    network::Cluster const cluster = diary.stage("grow", [&] { return network::grow_dla(wanted.dla, run); });
    diary.say(
        fmt::format("{} particles  seed {}  radius {:.0f} cells", cluster.cells.size(), recipe.seed, cluster.radius));
    terrain.story.particles = static_cast<std::int64_t>(cluster.cells.size());
    terrain.story.walkers = cluster.walkers;

    network::BranchParams branch_params{wanted.branch, 0, 0};
    if (recipe.grid.width > 0) {
        branch_params.max_width = room_for_network(recipe.grid.width);
        branch_params.max_height = room_for_network(recipe.grid.height);
    }
    network::Branch const branch = network::pick_branch(cluster, branch_params);
    terrain.story.cut = branch.cut;
    FramedBranch const framed = frame_branch(branch, recipe.grid);
    Mask const skeleton = diary.stage("thin", [&] { return network::thin(framed.mask, run); });
    StreamNetwork plan = diary.stage("trace", [&] { return network::trace(skeleton, {framed.mouth}, run); });
    return {std::move(plan), framed.mask.grid(), {}};
}

Planned adopt(Recipe& recipe, Terrain& terrain, Diary& diary, Run const& run) {
    LinesRecipe const& wanted = recipe.network->lines;
    std::string const crs = recipe.grid.crs.empty() ? "" : io::projected_crs(recipe.grid.crs);
    RiverLines lines = diary.stage("read", [&] {
        return io::read_rivers({file_in(recipe, wanted.path), wanted.layer, wanted.type_field, wanted.rank_field, crs},
                               run);
    });
    recipe.grid.crs = lines.crs;
    diary.say(fmt::format("{} lines from {}", lines.lines.size(), lines.name));
    Grid const grid = frame_lines(lines, recipe.grid);
    if (recipe.grid.clip) {
        lines = network::clip_lines(lines, grid);
        if (lines.lines.empty()) {
            throw BadInput(fmt::format("grid: no river of {} runs inside the grid", lines.name));
        }
    }
    network::Adopted adopted = diary.stage("adopt", [&] {
        return network::adopt(lines, {wanted.snap_m, wanted.orientation}, run);
    });
    diary.say(fmt::format("{} arcs, {} repairs", boost::num_edges(adopted.network), adopted.repairs.size()));
    terrain.story.repairs = adopted.repairs;

    Planned planned{std::move(adopted.network), grid, {}};
    Heights& heights = recipe.network->heights;
    if (heights == Heights::automatic) {
        heights = lines.has_z ? Heights::file : Heights::straight_repaired;
    }
    if (heights == Heights::file) {
        if (!lines.has_z) {
            throw BadInput(fmt::format("network.heights: 'file' is asked, but {} has lines without Z. Choose another.",
                                       lines.name));
        }
        planned.file_heights = network::take_file_heights({planned.plan, adopted.arc_z, {}}, lines);
    }
    return planned;
}

/// Types of rivers, where heights follow from them or they are asked for, written to the arcs.
void assign_types(Planned& planned, Terrain& terrain, Run const& run) {
    NetworkRecipe const& wanted = *terrain.recipe.network;
    if (wanted.heights != Heights::rosgen && !(wanted.coast_m > 0.0)) {
        return;
    }
    network::AssignTypesParams params;
    params.choice = wanted.rosgen ? network::TypeChoice::one : network::TypeChoice::by_order;
    params.one = wanted.rosgen.value_or(params.one);
    params.coast_m = wanted.coast_m;
    terrain.types = network::assign_types(planned.plan, network::order(planned.plan), params, run);
    NetworkIndex const index(planned.plan);
    for (std::size_t a = 0; a < index.arcs.size(); ++a) {
        planned.plan[index.arcs[a]].type = network::name_of(terrain.types.type[a]);
    }
}

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

} // namespace

void make_rivers(Terrain& terrain, Diary& diary, Run const& run) {
    Recipe& recipe = terrain.recipe;
    NetworkRecipe& rivers = *recipe.network;
    Planned planned =
        rivers.source == Source::dla ? grow(recipe, terrain, diary, run) : adopt(recipe, terrain, diary, run);
    take_frame(terrain, planned.grid);
    Grid const& grid = terrain.grid;
    if (rivers.heights == Heights::automatic) {
        rivers.heights = Heights::straight_repaired;
    }
    if (!rivers.prune_cells) {
        rivers.prune_cells = rivers.source == Source::dla ? 20.0 : 0.0;
    }

    network::Pruned pruned = diary.stage("prune", [&] {
        return network::prune(planned.plan, {*rivers.prune_cells, grid.cell_m}, run);
    });
    terrain.story.arcs_traced = pruned.arcs_before;
    terrain.story.arcs_kept = static_cast<std::int64_t>(boost::num_edges(pruned.network));
    diary.say(
        fmt::format("L={}   {} of {} arcs kept", *rivers.prune_cells, terrain.story.arcs_kept, pruned.arcs_before));
    network::Carried carried = network::carry_outlets(pruned.network, grid);
    terrain.story.repairs.insert(terrain.story.repairs.end(), carried.notes.begin(), carried.notes.end());
    planned.plan = std::move(carried.network);

    assign_types(planned, terrain, run);
    terrain.network = diary.stage("raise", [&] { return raise(planned, terrain, run); });
    terrain.orders = network::order(terrain.network.plan);
    network::Rasterised rasterised = network::rasterise(terrain.network, grid);
    terrain.valley = std::move(rasterised.valley);
    terrain.story.lowered_cells = rasterised.lowered_cells;
    terrain.story.max_lowered_m = rasterised.max_lowered_m;
}

} // namespace thalweg::pipeline
