// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/cells.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/network/elevation/keep_heights.hpp>
#include <thalweg/network/import/import_lines.hpp>
#include <thalweg/network/import/land_and_sea.hpp>
#include <thalweg/pipeline/make/internal/given.hpp>
#include <thalweg/pipeline/make/internal/rivers.hpp>
#include <thalweg/pipeline/plan/internal/plan.hpp>

#include <fmt/format.h>

#include <utility>

namespace thalweg::pipeline {

namespace {

/// What the file holds that is not a river.
std::vector<Finding> left_out(RiverLines const& lines) {
    std::vector<Finding> findings = lines.findings;
    for (SecondaryLine const& one : lines.secondary) {
        if (one.cause == LeftOut::grid) {
            continue;
        }
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
Mask land_of_coastlines(Plan const& plan, Diary& diary, Run const& run) {
    if (!has_coastlines(plan)) {
        return {};
    }
    RiverLines coast;
    for (SecondaryLine const& line : plan.lines.secondary) {
        if (line.cause == LeftOut::coast) {
            RiverLine& one = coast.lines.emplace_back();
            one.feature = line.feature;
            one.vertices = line.vertices;
        }
    }
    Grid const& grid = *plan.grid;
    network::LandAndSea divided =
        diary.stage("sea", [&] { return network::land_and_sea(coast, plan.lines, grid, run); });
    diary.say(fmt::format("{:.3g} % of the grid, by {} coastlines",
                          100.0 * static_cast<double>(divided.sea_cells) / static_cast<double>(grid.cells()),
                          coast.lines.size()));
    if (4 * divided.beyond > divided.behind) {
        run.say(fmt::format("warning: rivers lie on both sides of the coastlines of {} ({} cells, and {} on the side "
                            "that became sea); --set network.lines.coastlines=none leaves the coastlines out.",
                            plan.lines.name, divided.behind, divided.beyond));
    }
    return std::move(divided.land);
}

/// What the file holds beside the network.
RiverFile file_of(RiverLines const& lines, network::Imported const& imported) {
    RiverFile file;
    file.secondary = lines.secondary;
    file.attributes = lines.attributes;
    file.sources = LineSources(imported.network, imported.stretches);
    file.secondary.insert(file.secondary.end(), imported.secondary.begin(), imported.secondary.end());
    file.adopted = imported.network;
    for (RiverLine const& line : lines.lines) {
        file.taken_m += length_in_plan(line.vertices);
    }
    return file;
}

/// What was turned, and what is doubtful.
void say_directions(network::Directions const& directions, bool has_dem, Run const& run) {
    if (std::string const turned = turned_in_words(directions); !turned.empty()) {
        run.tell("directions", turned);
    }
    for (std::string const& doubt :
         direction_doubts(directions, has_dem ? "" : "--set network.lines.dem=FILE",
                          "--set network.lines.orientation=as_drawn (or height, rank, topology)")) {
        run.say("warning: " + doubt);
    }
}

/// The heights of the file, where the recipe takes them.
std::optional<ElevatedNetwork> heights_of_file(Plan const& plan, network::Imported const& imported) {
    Heights const heights = plan.recipe.network->heights;
    bool const or_straight = heights == Heights::soft || heights == Heights::fixed || heights == Heights::ends;
    if (heights == Heights::file || (or_straight && plan.lines.has_z)) {
        return network::take_file_heights({imported.network, imported.arc_z, {}}, plan.lines);
    }
    return std::nullopt;
}

} // namespace

RiversInPlan rivers_of_lines(Plan const& plan, Diary& diary, Run const& run) {
    LinesRecipe const& wanted = plan.recipe.network->lines;
    network::ImportParams const params{.snap_m = wanted.snap_m,
                                       .orientation = wanted.orientation,
                                       .divergences = wanted.divergences,
                                       .dem = plan.line_dem.cells() > 0 ? &plan.line_dem : nullptr};
    network::Imported imported = diary.stage("adopt", [&] { return network::import_lines(plan.lines, params, run); });
    RiversInPlan rivers;
    rivers.grid = *plan.grid;
    rivers.story.heights_of_file = plan.heights_of_file;
    std::vector<Finding>& repairs = rivers.story.repairs;
    repairs = left_out(plan.lines);
    repairs.insert(repairs.end(), imported.repairs.begin(), imported.repairs.end());
    rivers.file = file_of(plan.lines, imported);
    std::size_t const secondary = rivers.file.secondary.size();
    diary.say(fmt::format("{} arcs, {} repairs{}", imported.network.arc_count(), repairs.size(),
                          secondary == 0 ? "" : fmt::format(", {} secondary", secondary)));
    say_directions(imported.directions, params.dem != nullptr, run);
    repairs.insert(repairs.end(), imported.directions.doubts.begin(), imported.directions.doubts.end());
    warn_of_gaps(imported.network, rivers.grid, wanted.snap_m, run);
    rivers.land = land_of_coastlines(plan, diary, run);
    rivers.file_heights = heights_of_file(plan, imported);
    rivers.network = std::move(imported.network);
    return rivers;
}

} // namespace thalweg::pipeline
