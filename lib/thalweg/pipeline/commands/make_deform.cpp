// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/commands/make_deform.hpp>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/pipeline/plan/internal/read_inputs.hpp>

namespace thalweg::pipeline {

blend::Deformed make_deform(MakeDeformParams const& params, Run const& run) {
    if (params.scale == 1.0 && params.handles.empty()) {
        throw BadParameter("pipeline.make_deform: nothing to do: give a scale or heights to pull to");
    }
    Raster<float> const target = io::read_dem(params.target, {.nodata = params.nodata}, run);
    Grid const& grid = target.grid();
    Mask const region = read_part(params.mask, grid, run);
    std::vector<blend::Handle> handles;
    for (Vec3 const& h : params.handles) {
        Cell const cell = grid.cell_of({h.x, h.y});
        if (!grid.contains(cell)) {
            throw BadInput(fmt::format("pipeline.make_deform: ({}, {}) lies outside {}, which reaches from ({}, {}) to "
                                       "({}, {})",
                                       h.x, h.y, params.target, grid.west, grid.south(), grid.east(), grid.north));
        }
        handles.push_back({cell, h.z});
    }
    run.at(0.0, "deform");
    return blend::deform(target, region, handles, {.scale = params.scale}, run);
}

} // namespace thalweg::pipeline
