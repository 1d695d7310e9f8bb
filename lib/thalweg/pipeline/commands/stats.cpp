// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/commands/stats.hpp>

#include <utility>
#include <vector>

#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/io/raster/read_drawable.hpp>

namespace thalweg::pipeline {

StatsResult run_stats(StatsParams const& params, Run const& run) {
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
        Raster<float> const ground = on_ground(dem);
        flow::FlowField const drainage = flow::route(ground, run);
        if (params.laws) {
            found.laws = laws_of_dem(ground, drainage, flow::flow_lengths(drainage, run),
                                     {.support_cells = params.support_cells}, run);
        }
        if (params.relief) {
            found.relief = relief_of_dem(ground, drainage, run);
        }
    }
    if (params.recipe) {
        found.recipe = recipe_of_dem(dem, found.statistics, params.path);
    }
    return found;
}

} // namespace thalweg::pipeline
