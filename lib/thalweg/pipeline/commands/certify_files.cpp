// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/commands/internal/certify_files.hpp>

#include <cmath>
#include <limits>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/pipeline/make/internal/river_claims.hpp>

namespace thalweg::pipeline {

namespace {

/// By reach, the contributing area the file gives its lower end.
std::vector<double> areas_of(NetworkFile const& file, std::vector<flow::Reach> const& reaches) {
    std::unordered_map<std::int64_t, double> by_id;
    for (NetworkFile::FileArc const& arc : file.arcs) {
        by_id.try_emplace(arc.id, arc.ds_area_m2);
    }
    std::vector<double> areas;
    areas.reserve(reaches.size());
    for (flow::Reach const& reach : reaches) {
        areas.push_back(file.says.areas ? by_id.at(reach.id) : std::numeric_limits<double>::quiet_NaN());
    }
    return areas;
}

/// The cells of a raster above 0; without cells where there is none on this grid.
Mask cells_in(std::string const& raster, Grid const& grid) {
    if (raster.empty()) {
        return {};
    }
    Raster<float> const values = io::read_stored_dem(raster, {.values = io::CellValues::numbers});
    if (values.grid() != grid) {
        return {};
    }
    Mask cells(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        cells[i] = values[i] > 0.0F ? 1 : 0;
    }
    return cells;
}

} // namespace

measure::Certificate certify_files(NetworkFile const& network, DemFile const& file, RiverRasters const& rasters,
                                   Run const& run) {
    std::string const& dem = file.path;
    Raster<float> const land =
        io::read_stored_dem(dem, {.nodata = file.nodata}, run); // in feet or metres its water runs alike
    if (!io::same_crs(network.crs, land.grid().crs, "the network", dem)) {
        std::string const lines = network.crs.substr(0, 60);
        throw BadInput(fmt::format("pipeline.certify_files: the network is in {}, {} in {}; reproject one of them "
                                   "(ogr2ogr -t_srs, gdalwarp -t_srs {} {} OUT.tif)",
                                   lines, dem, land.grid().crs.substr(0, 60), lines, dem));
    }
    FileReaches const found = reaches_of_file(network, land.grid());
    measure::Claims claims;
    claims.ds_area_m2 = areas_of(network, found.reaches);
    claims.still = either(still_cells(network, land.grid()), cells_in(rasters.lakes, land.grid()));
    claims.drawn = cells_in(rasters.drawn, land.grid());
    claims.honoured = rasters.waive ? claims.drawn : Mask{};
    flow::FlowField const drainage = flow::route(land, sinks_of(network, land), run);
    measure::Certificate certificate = measure::certify(land, drainage, found.reaches, claims, run);
    for (flow::Reach const& reach : found.reaches) {
        if (reach.lines.empty()) {
            certificate.findings.push_back(
                {"outside_dem", reach.id, {}, 0.0, fmt::format("arc {} lies outside the DEM", reach.id)});
        }
    }
    return certificate;
}

} // namespace thalweg::pipeline
