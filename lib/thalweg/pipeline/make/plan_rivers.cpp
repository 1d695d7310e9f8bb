// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/internal/plan_rivers.hpp>

#include <thalweg/core/cells/cells_along.hpp>
#include <thalweg/core/cells/cells_around.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/io/frame/projection.hpp>
#include <thalweg/io/network/read_rivers.hpp>
#include <thalweg/network/elevation/keep_heights.hpp>
#include <thalweg/network/import/choose_cell.hpp>
#include <thalweg/network/import/clip_lines.hpp>
#include <thalweg/network/import/fill_heights.hpp>
#include <thalweg/network/import/land_and_sea.hpp>
#include <thalweg/network/planform/rotate.hpp>
#include <thalweg/network/vectorise/thin.hpp>
#include <thalweg/network/vectorise/trace.hpp>
#include <thalweg/pipeline/make/internal/land_in_equilibrium.hpp>
#include <thalweg/pipeline/plan/frame.hpp>
#include <thalweg/pipeline/plan/internal/stray_vertex.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_asks.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_files.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace thalweg::pipeline {

namespace {

/// A frame for what will be turned before it is put into the grid that is asked for.
GridRecipe loosely_framed(GridRecipe frame) {
    frame.width = 0;
    frame.height = 0;
    return frame;
}

/// The grid asked for, or one with room for the whole branch as it was picked: when that is asked for, the branch is
/// cut no shorter.
Grid turned_frame(network::Branch const& branch, Grid frame, GridRecipe const& wanted, double turn_deg) {
    frame.width = wanted.width;
    frame.height = wanted.height;
    if (frame.width == 0) {
        double const c = portable::cos(turn_deg / 180.0 * portable::pi);
        double const s = portable::sin(turn_deg / 180.0 * portable::pi);
        Vec2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
        Vec2 high{-low.x, -low.y};
        for (Cell const& cell : branch.cells) {
            auto const x = static_cast<double>(cell.col);
            auto const y = static_cast<double>(cell.row);
            Vec2 const at{c * x + s * y, c * y - s * x};
            low = {std::min(low.x, at.x), std::min(low.y, at.y)};
            high = {std::max(high.x, at.x), std::max(high.y, at.y)};
        }
        auto const wide = static_cast<std::int64_t>(std::ceil(high.x - low.x + 1.0));
        auto const tall = static_cast<std::int64_t>(std::ceil(high.y - low.y + 1.0));
        std::int64_t const margin = margin_around(std::max(wide, tall));
        frame.width = wide + 2 * margin;
        frame.height = tall + 2 * margin;
    }
    check_memory(frame.width, frame.height);
    return frame;
}

/// Why the cell size is what it is.
std::string reason(network::ChosenCell const& chosen) {
    std::string words = fmt::format(", from {} lines of {:.4g} km in all, {:.2g} km apart", chosen.lines,
                                    chosen.length_m / 1000.0, chosen.spacing_m / 1000.0);
    return words;
}

/// Says where rivers lie too close together for the cells.
void warn_of_crowding(network::ChosenCell const& chosen, Run const& run) {
    constexpr double worth_a_word = 0.002;
    if (chosen.crowded_share <= worth_a_word) {
        return;
    }
    run.say(fmt::format("warning: {:.1f} % of the river cells lie beside another river. {}",
                        100.0 * chosen.crowded_share,
                        chosen.enough_m > 0.0 ? fmt::format("--set grid.cell={} keeps them apart.", chosen.enough_m)
                                              : "Take a part of the rivers, or set a smaller grid.cell."));
}

/// A recipe with a mean slope, where it has neither one nor a relief, nor the rivers heights.
Recipe with_slope(Recipe recipe, bool has_z) {
    if (!in_equilibrium(recipe)) {
        return recipe;
    }
    Heights const heights = recipe.network->heights;
    bool const graded = heights == Heights::graded || (heights == Heights::automatic && !has_z);
    EquilibriumRecipe& wanted = recipe.surface->equilibrium;
    double const usual = usual_slope_deg(recipe.grid.cell_m);
    if (graded && !wanted.mean_slope_deg && !(recipe.surface->dilate.relief_m > 0.0) &&
        usual != surface::EquilibriumParams{}.mean_slope_deg) {
        wanted.mean_slope_deg = usual;
    }
    return recipe;
}

/// What the file holds that is not a river.
std::vector<Finding> left_out(RiverLines const& lines) {
    std::vector<Finding> findings = lines.findings;
    for (SecondaryLine const& one : lines.secondary) {
        std::vector<Vec2> plan;
        for (Vec3 const v : one.vertices) {
            plan.push_back({v.x, v.y});
        }
        findings.push_back({"secondary", one.feature, plan.front(), length_of(plan),
                            fmt::format("line {} is not a river: {}", one.feature, one.reason)});
    }
    return findings;
}

/// A word where rivers end so near to the course of others, not to their mouths, that they were meant to meet them.
void warn_of_gaps(StreamNetwork const& network, Grid const& grid, double snapped_m, Run const& run) {
    constexpr std::int64_t near_cells = 2;
    constexpr std::int64_t mouth_cells = 5;
    Raster<std::int64_t> basin(grid, 0);
    for (std::size_t a = 0; a < network.arc_count(); ++a) {
        for (Cell const c : cells_along(network.arc(a).line, grid, "a river")) {
            basin[c] = network.basin(network.to(a));
        }
    }
    auto const end_of = [&](NodeId outlet) { return cells_along({network.node(outlet).at}, grid).front(); };
    std::int64_t gaps = 0;
    for (NodeId const outlet : network.outlets()) {
        bool is_near = false;
        cells_around(grid, end_of(outlet), near_cells, [&](Cell c) {
            if (basin[c] != 0 && basin[c] != network.basin(outlet)) {
                Cell const mouth = end_of(network.outlets()[static_cast<std::size_t>(basin[c] - 1)]);
                is_near = is_near || squared_cells(mouth, end_of(outlet)) > mouth_cells * mouth_cells;
            }
        });
        gaps += is_near ? 1 : 0;
    }
    if (gaps > 0) {
        // Centres two cells apart along a diagonal are nearly three sides apart.
        double const reach_m = static_cast<double>(near_cells + 1) * grid.cell_m;
        run.say(fmt::format("warning: {} within {} cells of another river without meeting it. {}",
                            gaps == 1 ? "1 river ends" : fmt::format("{} rivers end", gaps), near_cells,
                            snapped_m < reach_m
                                ? fmt::format("If they should meet: --set network.lines.snap={}.", reach_m)
                                : fmt::format("Finer cells keep them apart: --set grid.cell={}.", grid.cell_m / 2.0)));
    }
}

/// The land beside the sea that coastlines of a file bound; without cells where there is none.
Mask land_of_coastlines(RiverLines const& lines, Grid const& grid, Diary& diary, Run const& run) {
    RiverLines coast;
    for (SecondaryLine const& line : lines.secondary) {
        if (line.is_coast) {
            RiverLine& one = coast.lines.emplace_back();
            one.feature = line.feature;
            one.vertices = line.vertices;
        }
    }
    if (coast.lines.empty()) {
        return {};
    }
    network::LandAndSea divided = diary.stage("sea", [&] { return network::land_and_sea(coast, lines, grid, run); });
    diary.say(fmt::format("{:.3g} % of the grid, by {} coastlines",
                          100.0 * static_cast<double>(divided.sea_cells) / static_cast<double>(grid.cells()),
                          coast.lines.size()));
    if (4 * divided.beyond > divided.behind) {
        run.say(fmt::format("warning: rivers lie on both sides of the coastlines of {} ({} cells, and {} on the side "
                            "that became sea); --set network.lines.coastlines=none leaves the coastlines out.",
                            lines.name, divided.behind, divided.beyond));
    }
    return std::move(divided.land);
}

} // namespace

RiverLines read_lines(Recipe const& recipe, Run const& run) {
    LinesRecipe const& wanted = recipe.network->lines;
    std::string const crs = recipe.grid.crs.empty() ? "" : io::projected_crs(recipe.grid.crs);
    RiverLines lines = io::read_rivers({.path = file_in(recipe, wanted.path),
                                        .layer = wanted.layer,
                                        .type_field = wanted.type_field,
                                        .rank_field = wanted.rank_field,
                                        .crs = crs,
                                        .filter = wanted.filter},
                                       run);
    auto const count = lines.lines.size();
    network::FilledHeights filled = network::fill_heights(std::move(lines), recipe.network->slope);
    if (filled.filled > 0) {
        run.say(fmt::format("warning: {} of {} lines in {} have no heights, the first is feature {}. They get heights "
                            "from the lines they meet, with network.slope where they meet only one.",
                            filled.filled, count, filled.lines.name, filled.first));
    }
    return std::move(filled.lines);
}

OnLines settle_on_lines(Recipe recipe, RiverLines const& lines, Run const& run) {
    recipe.grid.crs = lines.crs;
    if (recipe.grid.cell_m > 0.0) {
        return {with_slope(std::move(recipe), lines.has_z), ""};
    }
    if (recipe.grid.width == 0) {
        require_no_stray_vertex(lines);
    }
    network::ChosenCell const chosen =
        network::choose_cell(lines, {.width = recipe.grid.width, .height = recipe.grid.height}, run);
    recipe.grid.cell_m = chosen.cell_m;
    warn_of_crowding(chosen, run);
    return {with_slope(std::move(recipe), lines.has_z), reason(chosen)};
}

Planned plan_dla(Recipe recipe, Diary& diary, Run const& run) {
    NetworkStory story;
    NetworkRecipe& wanted = *recipe.network;
    recipe.grid.crs = io::projected_crs(recipe.grid.crs.empty() ? "EPSG:32631" : recipe.grid.crs);
    if (recipe.grid.width > 0) {
        check_memory(recipe.grid.width, recipe.grid.height);
    }
    check_memory_of_cluster(wanted.dla.particles);
    wanted.dla.seed = recipe.seed;
    run.at(0.0, fmt::format("grow {} particles", wanted.dla.particles).c_str());
    network::Cluster const cluster = diary.stage("grow", [&] { return network::grow_dla(wanted.dla, run); });
    story.wide = cluster.stop == network::GrowthStop::radius;
    diary.say(fmt::format("{} particles  seed {}  radius {:.0f} cells{}", cluster.cells.size(), recipe.seed,
                          cluster.radius, story.wide ? ", where it stops" : ""));
    story.particles = static_cast<std::int64_t>(cluster.cells.size());
    story.walkers = cluster.walkers;

    wanted.rotate_deg = wanted.rotate_deg.value_or(in_equilibrium(recipe) ? network::random_turn(recipe.seed) : 0.0);
    double const turn_deg = *wanted.rotate_deg;
    network::BranchParams branch_params{wanted.branch, 0, 0, turn_deg};
    if (recipe.grid.width > 0) {
        branch_params.max_width = room_for_network(recipe.grid.width);
        branch_params.max_height = room_for_network(recipe.grid.height);
    }
    network::Branch const branch = network::pick_branch(cluster, branch_params);
    story.cut = branch.cut;
    FramedBranch const framed = frame_branch(branch, turn_deg == 0.0 ? recipe.grid : loosely_framed(recipe.grid));
    Mask const skeleton = diary.stage("thin", [&] { return network::thin(framed.mask, run); });
    StreamNetwork plan = diary.stage("trace", [&] { return network::trace(skeleton, {framed.mouth}, run); });
    Grid grid = framed.mask.grid();
    if (turn_deg != 0.0) {
        network::Rotated turned = network::rotate(plan, turned_frame(branch, grid, recipe.grid, turn_deg), {turn_deg});
        plan = std::move(turned.network);
        grid = turned.grid;
    }
    return {.recipe = std::move(recipe), .plan = std::move(plan), .grid = grid, .story = std::move(story)};
}

Planned plan_lines(Recipe given, Diary& diary, Run const& run) {
    RiverLines lines = diary.stage("read", [&] { return read_lines(given, run); });
    diary.say(fmt::format("{} lines from {}", lines.lines.size(), lines.name));
    auto [recipe, why] = settle_on_lines(std::move(given), lines, run);
    LinesRecipe const& wanted = recipe.network->lines;
    Grid const grid = frame_lines(lines, recipe.grid);
    run.tell("grid", fmt::format("{}x{} cells of {} m{}", grid.width, grid.height, grid.cell_m, why));
    if (recipe.grid.clip) {
        lines = network::clip_lines(lines, grid);
        if (lines.lines.empty()) {
            throw BadInput(fmt::format("grid: no river of {} runs inside the grid", lines.name));
        }
    }
    network::Imported imported = diary.stage("adopt", [&] {
        return network::import_lines(
            lines, {.snap_m = wanted.snap_m, .orientation = wanted.orientation, .divergences = wanted.divergences},
            run);
    });
    NetworkStory story;
    story.repairs = left_out(lines);
    story.repairs.insert(story.repairs.end(), imported.repairs.begin(), imported.repairs.end());
    RiverFile file;
    file.secondary = lines.secondary;
    for (RiverLine const& line : lines.lines) {
        file.drawn.push_back({line.feature, line.vertices, "", line.feature});
    }
    file.attributes = std::move(lines.attributes);
    file.sources = LineSources(imported.network, imported.stretches);
    file.secondary.insert(file.secondary.end(), imported.secondary.begin(), imported.secondary.end());
    diary.say(fmt::format("{} arcs, {} repairs{}", imported.network.arc_count(), story.repairs.size(),
                          file.secondary.empty() ? "" : fmt::format(", {} secondary", file.secondary.size())));

    warn_of_gaps(imported.network, grid, wanted.snap_m, run);
    Mask land = wanted.coastlines == Coastlines::sea ? land_of_coastlines(lines, grid, diary, run) : Mask{};
    Heights& heights = recipe.network->heights;
    if (heights == Heights::automatic) {
        story.heights_of_file = lines.has_z;
        heights = lines.has_z ? Heights::file : in_equilibrium(recipe) ? Heights::graded : Heights::straight_repaired;
    }
    bool const or_straight = heights == Heights::soft || heights == Heights::fixed || heights == Heights::ends;
    std::optional<ElevatedNetwork> file_heights;
    if (heights == Heights::file || (or_straight && lines.has_z)) {
        if (!lines.has_z) {
            throw BadInput(fmt::format("network.heights = \"file\", but {} has lines without Z; choose other heights",
                                       lines.name));
        }
        file_heights = network::take_file_heights({imported.network, imported.arc_z, {}}, lines);
    }
    return {
        std::move(recipe), std::move(imported.network), grid, std::move(file_heights), std::move(land), std::move(file),
        std::move(story)};
}

} // namespace thalweg::pipeline
