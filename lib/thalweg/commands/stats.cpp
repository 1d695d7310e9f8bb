// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/commands/stats.hpp>

#include <filesystem>
#include <iterator>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <thalweg/core/append.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/vec.hpp>

#include <thalweg/commands/internal/repair_network.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/io/network/read_network.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/io/raster/read_drawable.hpp>
#include <thalweg/io/sources/sources.hpp>
#include <thalweg/measure/topology/topology.hpp>

namespace thalweg::commands {

namespace {

bool holds_lines(std::string const& path) {
    std::error_code ignored;
    try {
        return !std::filesystem::is_directory(path, ignored) &&
               io::content_of(path).kind == io::FileContent::Kind::lines;
    } catch (BadInput const&) { // whoever reads it says what it is
        return false;
    }
}

StatsResult stats_of_lines(StatsParams const& params, Run const& run) {
    io::ReadNetworkParams read;
    read.any_lines = true;
    read.bridge = true;
    NetworkFile const file = io::read_network(params.path, read, run);
    RepairedNetwork const mended = repair_network(file, measure::check_topology(file, {}, run), {}, run);
    refuse_if<BadInput>(!mended.done, "commands.run_stats", "{} makes no tree of rivers: {}", params.path,
                        mended.mended.empty() ? std::string("thalweg check tells why") : mended.mended.back().text);
    StatsResult found;
    found.findings = file.findings;
    append(found.findings, mended.doubts);
    run.report(found.findings);
    flow::ContributingAreas areas;
    areas.us_area_m2 = mended.us_area_m2;
    areas.ds_area_m2 = mended.ds_area_m2;
    found.lines = make::laws_of_lines({mended.network, mended.orders, areas, mended.has_heights});
    found.lines->left_out = std::ssize(mended.secondary);
    for (SecondaryLine const& line : mended.secondary) {
        found.lines->left_out_m += length_in_plan(line.vertices);
    }
    return found;
}

} // namespace

StatsResult run_stats(StatsParams const& params, Run const& run) {
    if (holds_lines(params.path)) {
        refuse_if<BadParameter>(
            !params.laws || params.relief || params.recipe, "commands.run_stats",
            "{} holds lines, whose laws alone are measured: give --laws, without --relief and --recipe", params.path);
        return stats_of_lines(params, run);
    }
    constexpr std::int64_t any_side = 1000000;
    io::Drawable read =
        io::read_drawable(params.path, {.most_side = any_side, .reading = params.reading, .summarises = true}, run);
    Raster<float> const& dem = read.dem;
    std::vector<Finding> findings = std::move(read.findings);
    run.report(findings);
    StatsResult found{.grid = dem.grid(), .statistics = measure::statistics(dem, run), .findings = std::move(findings)};
    if (read.own) { // heights are those of the file; slopes and lengths need squares in metres
        found.statistics.cells = read.own->cells;
        found.statistics.nodata = read.own->nodata;
        found.statistics.mean = read.own->mean;
        found.statistics.std = read.own->std;
        found.statistics.min.z = read.own->min;
        found.statistics.max.z = read.own->max;
        found.statistics.skew = read.own->skew;
        found.statistics.kurtosis = read.own->kurtosis;
    }
    if (params.laws || params.relief) {
        Raster<float> const ground = make::on_ground(dem);
        flow::FlowField const drainage = flow::route(ground, run);
        if (params.laws) {
            found.laws = make::laws_of_dem(ground, drainage, {.support_cells = params.support_cells}, run);
        }
        if (params.relief) {
            found.relief = make::relief_of_dem(ground, drainage, run);
        }
    }
    if (params.recipe) {
        found.recipe = recipe::recipe_of_dem(dem, found.statistics, params.path);
    }
    return found;
}

} // namespace thalweg::commands
