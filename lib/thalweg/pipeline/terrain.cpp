// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/terrain.hpp>

#include <thalweg/core/error.hpp>
#include <thalweg/io/projection.hpp>
#include <thalweg/io/raster_files.hpp>
#include <thalweg/io/read_rivers.hpp>
#include <thalweg/measure/topology.hpp>
#include <thalweg/network/carry_outlets.hpp>
#include <thalweg/network/clip_lines.hpp>
#include <thalweg/network/keep_heights.hpp>
#include <thalweg/network/order.hpp>
#include <thalweg/network/prune.hpp>
#include <thalweg/network/rasterise.hpp>
#include <thalweg/network/thin.hpp>
#include <thalweg/network/trace.hpp>
#include <thalweg/pipeline/diary.hpp>
#include <thalweg/pipeline/frame.hpp>
#include <thalweg/pipeline/land.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace thalweg::pipeline {

namespace {

/// A network in plan on its grid, with the file's heights where lines carry them.
struct Planned {
    StreamNetwork plan;
    Grid grid;
    std::optional<RaisedNetwork> file_heights;
};

std::string file_in(Recipe const& recipe, std::string const& name) {
    return recipe.folder.empty() || name.empty() || name.front() == '/' ? name : recipe.folder + "/" + name;
}

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

RaisedNetwork raise(Planned const& planned, NetworkRecipe const& wanted, NetworkStory& story, Run const& run) {
    if (planned.file_heights) {
        return network::keep_heights(planned.plan, *planned.file_heights, wanted.slope);
    }
    network::HeightMode const mode = wanted.heights == Heights::straight       ? network::HeightMode::straight
                                     : wanted.heights == Heights::along_stream ? network::HeightMode::along_stream
                                                                               : network::HeightMode::straight_repaired;
    network::Raised raised = network::set_heights(planned.plan, {mode, wanted.slope}, run);
    story.heights = raised.report;
    return std::move(raised.network);
}

Mask read_inside(Recipe const& recipe, Valley const& valley) {
    Raster<float> const given = io::read_dem(file_in(recipe, recipe.surface->mask));
    Grid const& grid = valley.z.grid();
    if (given.width() != grid.width || given.height() != grid.height) {
        throw BadInput(fmt::format("surface.mask: {} has {}x{} cells, the grid {}x{}", recipe.surface->mask,
                                   given.width(), given.height(), grid.width, grid.height));
    }
    Mask inside(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        inside[i] = !std::isnan(given[i]) && given[i] != 0.0F;
        if (inside[i] == 0 && !std::isnan(valley.z[i])) {
            Cell const c = grid.at(i);
            throw BadInput(fmt::format("surface.mask: {} leaves out cell ({}, {}), where a river runs",
                                       recipe.surface->mask, c.col, c.row));
        }
    }
    return inside;
}

surface::Dilated draw_surface(Recipe const& recipe, Valley const& valley, Run const& run) {
    surface::DilateParams const& params = recipe.surface->dilate;
    return recipe.surface->mask.empty() ? surface::dilate(valley, params, run)
                                        : surface::dilate(valley, read_inside(recipe, valley), params, run);
}

std::int64_t uphill_arcs(RaisedNetwork const& network) {
    return std::count_if(network.arc_z.begin(), network.arc_z.end(), [](std::vector<double> const& z) {
        return !(z.front() > z.back()) || std::adjacent_find(z.begin(), z.end(), std::less<>()) != z.end();
    });
}

std::int64_t valley_cells_moved(Valley const& valley, Raster<float> const& dem) {
    std::int64_t moved = 0;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        moved += !std::isnan(valley.z[i]) && !(valley.z[i] == dem[i]);
    }
    return moved;
}

Check none_of(char const* name, std::int64_t count) {
    return {name, static_cast<double>(count), 0.0, count == 0};
}

void frame(Terrain& terrain, Grid const& grid) {
    terrain.grid = grid;
    terrain.recipe.grid.width = grid.width;
    terrain.recipe.grid.height = grid.height;
    terrain.recipe.grid.origin = {grid.west, grid.north};
}

/// Where the rivers run, and how high.
void make_rivers(Terrain& terrain, Diary& diary, Run const& run) {
    Recipe& recipe = terrain.recipe;
    NetworkRecipe& rivers = *recipe.network;
    Planned planned =
        rivers.source == Source::dla ? grow(recipe, terrain, diary, run) : adopt(recipe, terrain, diary, run);
    frame(terrain, planned.grid);
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

    terrain.network = diary.stage("raise", [&] { return raise(planned, rivers, terrain.story, run); });
    terrain.orders = network::order(terrain.network.plan);
    network::Rasterised rasterised = network::rasterise(terrain.network, grid);
    terrain.valley = std::move(rasterised.valley);
    terrain.story.lowered_cells = rasterised.lowered_cells;
    terrain.story.max_lowered_m = rasterised.max_lowered_m;
}

/// The land around the rivers.
void draw_land(Terrain& terrain, FeaturePoints const& points, Diary& diary, Run const& run) {
    Recipe const& recipe = terrain.recipe;
    SurfaceRecipe const& wanted = *recipe.surface;
    bool const over_tin = wanted.method == Method::tin || wanted.base == Base::tin;
    if (over_tin || (recipe.skeleton && recipe.skeleton->tin)) {
        make_skeleton_tin(terrain, points, diary, run);
    }
    terrain.surface = diary.stage(
        "fill", [&] { return over_tin ? draw_over_tin(terrain, run) : draw_surface(recipe, terrain.valley, run); });
    bool const dilated = wanted.method == Method::dilate;
    diary.say(fmt::format("{}x{}, {}", terrain.grid.width, terrain.grid.height,
                          dilated
                              ? fmt::format("{}, {} levels", wanted.dilate.increment.increment, terrain.surface->levels)
                              : std::string("over triangles")));
    add_detail(terrain, terrain.surface->dem, run);
}

void measure_land(Terrain& terrain, Diary& diary, Run const& run) {
    if (!terrain.surface) {
        terrain.areas = measure::areas_nearest(terrain.network.plan, terrain.grid, run);
        return;
    }
    Raster<float> const& dem = terrain.surface->dem;
    terrain.statistics = diary.stage("measure", [&] { return measure::statistics(dem, run); });
    terrain.hypsometry = measure::hypsometry(dem, run);
    run.at(0.0, fmt::format("drain {} cells", terrain.grid.cells()).c_str());
    measure::Drainage const drainage = diary.stage("drain", [&] { return measure::drain(dem, run); });
    terrain.pits = drainage.pits;
    terrain.pit_volume_m3 = drainage.pit_volume_m3;
    if (terrain.recipe.network) {
        terrain.areas = measure::areas_d8(terrain.network.plan, drainage, run);
        terrain.checks.push_back(none_of("valley_cells_moved", valley_cells_moved(terrain.valley, dem)));
    }
}

void check_rivers(Terrain& terrain, Diary& diary, Run const& run) {
    terrain.laws = measure::horton(terrain.network.plan, terrain.orders, terrain.areas.ds_area_m2);
    measure::TopologyReport topology = diary.stage(
        "check", [&] { return measure::check_topology(measure::as_file(terrain.network, terrain.orders), run); });
    terrain.checks.insert(terrain.checks.begin(), none_of("uphill_arcs", uphill_arcs(terrain.network)));
    terrain.checks.insert(terrain.checks.end(), topology.checks.begin(), topology.checks.end());
    terrain.findings = std::move(topology.findings);
}

} // namespace

bool Terrain::passed() const {
    return std::all_of(checks.begin(), checks.end(), [](Check const& c) { return c.ok; });
}

Terrain make_terrain(Recipe const& wanted, Run const& run, Keep const& keep) {
    check_recipe(wanted);
    Terrain terrain;
    terrain.recipe = wanted;
    Diary diary(run, terrain);
    FeaturePoints points;
    if (wanted.network) {
        make_rivers(terrain, diary, run);
        if (wanted.skeleton) {
            points = given_points(terrain.recipe, run);
        }
    } else {
        points = given_points(terrain.recipe, run);
        frame(terrain, frame_land(points, terrain.recipe.grid));
    }
    if (keep && wanted.network) {
        keep("valley", terrain.valley.z);
    }

    if (!wanted.network) {
        make_land(terrain, points, diary, run);
    } else if (wanted.surface) {
        draw_land(terrain, points, diary, run);
    }
    if (keep && terrain.surface) {
        keep("surface", terrain.surface->dem);
    }
    measure_land(terrain, diary, run);
    if (wanted.network) {
        check_rivers(terrain, diary, run);
    }
    return terrain;
}

} // namespace thalweg::pipeline
