// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/commands/dem_in_metres.hpp>

#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include <thalweg/io/frame/ground_cell.hpp>
#include <thalweg/io/frame/projection.hpp>
#include <thalweg/io/raster/read_dem.hpp>
#include <thalweg/io/raster/warp_to_grid.hpp>

namespace thalweg::pipeline {

MetricDem dem_in_metres(std::string const& path, Run const& run) {
    MetricDem out{io::read_dem(path, run), {}};
    Grid const own = out.dem.grid();
    io::GroundCell const ground = io::ground_cell(own);
    if (ground.unit != io::GridUnit::degrees) {
        return out;
    }
    Grid lattice;
    lattice.cell_m = ground.side_m;
    lattice.crs = io::utm_zone(0.5 * (own.west + own.east()), 0.5 * (own.south() + own.north));
    lattice.west = 0.0;
    lattice.north = 0.0;
    out.dem = io::warp_to_grid(out.dem, lattice, "pipeline.dem_in_metres: " + path, run);
    out.notes.push_back(fmt::format("{}: coordinates in degrees are reprojected into {}, onto cells of {:.2f} m",
                                    std::filesystem::path(path).filename().string(), lattice.crs, ground.side_m));
    return out;
}

} // namespace thalweg::pipeline
