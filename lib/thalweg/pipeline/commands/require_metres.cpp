// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/plan/internal/read_inputs.hpp>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/crs/crs.hpp>

namespace thalweg::pipeline {

void require_metres(Grid const& grid, std::string const& path, char const* who) {
    io::GroundCell const ground = io::ground_cell(grid);
    io::GridUnit const unit = ground.unit;
    if (unit == io::GridUnit::distorted) {
        throw BadInput(fmt::format("{}: the coordinates of {} are in {:.60}, whose metres are {:.3g} m on the ground "
                                   "there: reproject it first (gdalwarp -t_srs {:.60} {} OUT.tif)",
                                   who, path, grid.crs, ground.side_m / grid.cell_m, ground.crs, path));
    }
    if (unit == io::GridUnit::degrees || unit == io::GridUnit::other) {
        throw BadInput(fmt::format("{}: the coordinates of {} are {}: reproject it to a CRS in metres first "
                                   "(gdalwarp -t_srs)",
                                   who, path, unit == io::GridUnit::degrees ? "geographic" : "not in metres"));
    }
}

} // namespace thalweg::pipeline
