// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make_points.hpp>

#include <filesystem>
#include <limits>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/error.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/skeleton.hpp>
#include <thalweg/io/ground_cell.hpp>
#include <thalweg/io/raster_files.hpp>

namespace thalweg::pipeline {

namespace {

namespace fs = std::filesystem;

struct Rivers {
    Skeleton skeleton;
    Mask cells;
};

// Nobody's viewer draws degrees beside metres.
void require_metres(Grid const& grid, std::string const& path) {
    io::GridUnit const unit = io::ground_cell(grid).unit;
    if (unit == io::GridUnit::degrees || unit == io::GridUnit::other) {
        throw BadInput(fmt::format("pipeline.make_points: the coordinates of {} are {}: bring it into a projected CRS "
                                   "in metres first (gdalwarp -t_srs)",
                                   path, unit == io::GridUnit::degrees ? "geographic" : "not in metres"));
    }
}

// The land is taken over: a large one need not be there twice.
Rivers rivers_of(Raster<float> land, std::string const& path, Run const& run) {
    Raster<float> const drawn = io::read_dem(path, run);
    Grid const& grid = land.grid();
    if (drawn.grid() != grid) {
        throw BadInput(fmt::format("pipeline.make_points: {} has {} x {} cells, the DEM beside it {} x {}, or lies "
                                   "elsewhere: they belong to different lands",
                                   path, drawn.width(), drawn.height(), grid.width, grid.height));
    }
    Rivers rivers{{std::move(land)}, Mask(drawn.grid())};
    for (std::int64_t i = 0; i < drawn.cells(); ++i) {
        bool const wet = drawn[i] > 0.0F;
        rivers.cells[i] = wet ? 1 : 0;
        if (!wet) {
            rivers.skeleton.z[i] = std::numeric_limits<float>::quiet_NaN();
        }
    }
    return rivers;
}

} // namespace

MadePoints make_points(MakePointsParams const& params, std::string const& output, Run const& run) {
    std::error_code ignored;
    bool const is_folder = fs::is_directory(params.path, ignored);
    if (params.of == PointsOf::skeleton && !is_folder) {
        throw BadParameter(fmt::format("pipeline.make_points: a skeleton is that of a folder which make wrote; {} is "
                                       "none",
                                       params.path));
    }
    fs::path const folder(params.path);
    Raster<float> land = io::read_dem(is_folder ? (folder / "dem.tif").string() : params.path, run);
    require_metres(land.grid(), params.path);
    MadePoints made{0, land.grid().crs};
    if (params.of == PointsOf::skeleton) {
        Rivers const rivers = rivers_of(std::move(land), (folder / "network.tif").string(), run);
        made.count = io::write_points(rivers.skeleton, rivers.cells, output, params.write, run);
    } else {
        made.count = io::write_points(land, output, params.write, run);
    }
    return made;
}

} // namespace thalweg::pipeline
