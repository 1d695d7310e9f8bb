// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/commands/points.hpp>

#include <filesystem>
#include <limits>
#include <system_error>
#include <utility>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/mesh/points.hpp>
#include <thalweg/io/network/read_rivers.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/io/sources/sources.hpp>
#include <thalweg/recipe/read_inputs.hpp>

namespace thalweg::commands {

namespace {

namespace fs = std::filesystem;

/// A skeleton, and which of its cells are rivers.
struct SkeletonOfLand {
    Skeleton skeleton;
    Mask rivers;
};

/// Cells under the ridges of a network file; none if it has no such layer.
Mask ridges_of(std::string const& path, Grid const& grid, Run const& run) {
    if (!io::has_layer(path, "ridges")) {
        return Mask(grid);
    }
    return recipe::cells_under(io::read_rivers({.path = path, .layer = "ridges", .crs = grid.crs}, run), grid, path);
}

// Takes the terrain by value: a large one should not be copied.
SkeletonOfLand skeleton_of(Raster<float> land, fs::path const& folder, Run const& run) {
    Mask const ridges = ridges_of((folder / "network.gpkg").string(), land.grid(), run);
    SkeletonOfLand drawn{{std::move(land)}, {}};
    drawn.rivers = io::read_mask((folder / "network.tif").string(), drawn.skeleton.z.grid(), run);
    for (std::int64_t i = 0; i < ridges.cells(); ++i) {
        if (drawn.rivers[i] == 0 && ridges[i] == 0) {
            drawn.skeleton.z[i] = std::numeric_limits<float>::quiet_NaN();
        }
    }
    return drawn;
}

} // namespace

PointsResult run_points(PointsParams const& params, Run const& run) {
    io::WritePointsParams const write{io::point_format(params.format, params.output), params.every};
    io::OutputFile file(params.output, params.existing);
    std::error_code ignored;
    bool const is_folder = fs::is_directory(params.path, ignored);
    refuse_if<BadParameter>(params.of == PointsOf::skeleton && !is_folder, "commands.run_points",
                            "--skeleton needs a folder written by make; {} is not one", params.path);
    fs::path const folder(params.path);
    io::DemFile read = io::read_dem_file(is_folder ? (folder / "dem.tif").string() : params.path, params.reading, run);
    run.report(read.findings);
    Raster<float> land = std::move(read.dem);
    recipe::require_metres(land.grid(), params.path, "commands.run_points");
    PointsResult made{0, land.grid().crs, std::move(read.findings)};
    if (params.of == PointsOf::skeleton) {
        SkeletonOfLand const drawn = skeleton_of(std::move(land), folder, run);
        made.count = io::write_points(drawn.skeleton, drawn.rivers, file.staging(), write, run);
    } else {
        made.count = io::write_points(land, file.staging(), write, run);
    }
    file.commit();
    return made;
}

} // namespace thalweg::commands
