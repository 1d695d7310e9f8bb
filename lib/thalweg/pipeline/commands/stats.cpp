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
    std::vector<std::string> notes; // the changes, as sentences
};

/// Reads a DEM and warps it onto square cells in metres if necessary.
MetricDem dem_in_metres(std::string const& path, io::ReadDemParams const& params, Run const& run) {
    std::string const name = std::filesystem::path(path).filename().string();
    if (!io::has_square_cells(path)) {
        constexpr std::int64_t most_side = 30000;
        io::Drawable read = io::read_drawable(path, {.most_side = most_side, .nodata = params.nodata}, run);
        for (std::string& note : read.notes) {
            note.insert(0, name + ": ");
        }
        return {std::move(read.dem), std::move(read.notes)};
    }
    MetricDem out{io::read_dem(path, params, run), {}};
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
    out.notes.push_back(fmt::format("{}: coordinates in {} are reprojected into {}, onto cells of {:.2f} m", name,
                                    is_distorted ? fmt::format("{:.60}, whose metres are {:.2f} m on the ground,",
                                                               own.crs, ground.side_m / own.cell_m)
                                                 : "degrees",
                                    fmt::format("{:.60}", lattice.crs), ground.side_m));
    return out;
}

} // namespace

StatsResult run_stats(StatsParams const& params, Run const& run) {
    // A recipe has its own cells: recipe_of_dem determines their size.
    io::ReadDemParams const reading{.nodata = params.nodata};
    MetricDem const read = params.recipe ? MetricDem{io::read_dem(params.path, reading, run), {}}
                                         : dem_in_metres(params.path, reading, run);
    Raster<float> const& dem = read.dem;
    for (std::string const& note :
         read.notes.empty() ? io::conversions_of(params.path, "", dem.grid().crs) : read.notes) {
        run.say("note   " + note);
    }
    StatsResult found{dem.grid(), measure::statistics(dem, run)};
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
