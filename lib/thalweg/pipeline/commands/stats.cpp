// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/commands/stats.hpp>

#include <filesystem>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/gdal/sources.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/io/raster/read_drawable.hpp>

namespace thalweg::pipeline {

namespace {

struct MetricDem {
    Raster<float> dem;
    std::vector<Finding> findings; // the changes
};

/// Reads a DEM and warps it onto square cells in metres if necessary.
MetricDem dem_in_metres(std::string const& path, io::ReadDemParams const& params, Run const& run) {
    std::string const name = std::filesystem::path(path).filename().string();
    if (!io::has_square_cells(path)) {
        constexpr std::int64_t most_side = 30000;
        io::Drawable read = io::read_drawable(path, {.most_side = most_side, .nodata = params.nodata}, run);
        for (Finding& finding : read.findings) {
            finding.text.insert(0, name + ": ");
            finding.layer = name;
        }
        return {std::move(read.dem), std::move(read.findings)};
    }
    io::DemFile read = io::read_dem_file(path, params, run);
    MetricDem out{std::move(read.dem), std::move(read.findings)};
    Grid const own = out.dem.grid();
    io::GroundCell const ground = io::ground_cell(own);
    bool const is_distorted = ground.unit == io::GridUnit::distorted;
    if (ground.unit != io::GridUnit::degrees && !is_distorted) {
        return out;
    }
    Grid lattice;
    lattice.cell_m = ground.side_m;
    lattice.crs =
        is_distorted ? ground.crs : io::utm_zone(0.5 * (own.west + own.east()), 0.5 * (own.south() + own.north));
    lattice.west = 0.0;
    lattice.north = 0.0;
    out.dem = io::warp_to_grid(out.dem, lattice, "pipeline.run_stats: " + path, run);
    std::string const from = is_distorted ? fmt::format("{:.60}, whose metres are {:.2f} m on the ground,", own.crs,
                                                        ground.side_m / own.cell_m)
                                          : "degrees";
    out.findings.push_back(
        {.kind = "dem_reprojected",
         .amount = ground.side_m,
         .text = fmt::format("{}: coordinates in {} are reprojected into {:.60}, onto cells of {:.2f} m", name, from,
                             lattice.crs, ground.side_m),
         .layer = name});
    return out;
}

/// Reads a DEM on its own cells.
MetricDem as_it_is(std::string const& path, io::ReadDemParams const& params, Run const& run) {
    io::DemFile read = io::read_dem_file(path, params, run);
    return {std::move(read.dem), std::move(read.findings)};
}

} // namespace

StatsResult run_stats(StatsParams const& params, Run const& run) {
    // A recipe has its own cells: recipe_of_dem determines their size.
    io::ReadDemParams const reading{.nodata = params.nodata};
    MetricDem const read =
        params.recipe ? as_it_is(params.path, reading, run) : dem_in_metres(params.path, reading, run);
    Raster<float> const& dem = read.dem;
    std::vector<Finding> findings = read.findings;
    if (findings.empty()) {
        for (std::string const& words : io::conversions_of(params.path, "", dem.grid().crs)) {
            findings.push_back({.kind = "converted", .text = words});
        }
    }
    run.report(findings);
    StatsResult found{.grid = dem.grid(), .statistics = measure::statistics(dem, run), .findings = std::move(findings)};
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
