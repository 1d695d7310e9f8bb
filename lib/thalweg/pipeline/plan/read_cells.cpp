// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/plan/internal/read_inputs.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <thalweg/blend/mask_polygons.hpp>
#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/gdal/sources.hpp>
#include <thalweg/io/network/read_rivers.hpp>
#include <thalweg/io/raster/polygons.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/network/import/clip_lines.hpp>

namespace thalweg::pipeline {

Mask read_part(std::string const& path, Grid const& grid, Run const& run) {
    if (path.empty()) {
        return {};
    }
    return io::holds_polygons(path) ? blend::mask_polygons(io::read_polygons(path, grid.crs, run), grid)
                                    : io::read_mask(path, grid, run);
}

Mask cells_under(RiverLines const& lines, Grid const& grid, std::string const& what) {
    Mask under(grid);
    for (RiverLine const& line : lines.lines) {
        std::vector<Vec2> plan;
        for (Vec3 const& v : line.vertices) {
            plan.push_back({v.x, v.y});
        }
        for (Cell const c : cells_along(plan, grid, what)) {
            under[c] = 1;
        }
    }
    return under;
}

Mask read_kept(std::string const& path, Grid const& grid, Run const& run) {
    if (path.empty()) {
        return {};
    }
    io::FileContent const content = io::content_of(path);
    if (content.kind == io::FileContent::Kind::raster) {
        return io::read_mask(content.path, grid, run);
    }
    if (content.kind != io::FileContent::Kind::lines) {
        throw BadInput(fmt::format("pipeline.make_blend: {} holds points: cells to keep come from lines or a raster on "
                                   "the target's grid",
                                   content.path));
    }
    RiverLines const rivers = io::read_rivers({content.path, content.layer, "rosgen", {}, grid.crs}, run);
    io::same_crs(rivers.crs, grid.crs, "pipeline.make_blend: " + content.path, "the target");
    Mask kept = cells_under(network::clip_lines(rivers, grid), grid, content.path);
    if (std::ranges::find(kept.values(), 1) == kept.values().end()) {
        throw BadInput(fmt::format("pipeline.make_blend: no line of {} crosses the target, which reaches from "
                                   "({:.3f}, {:.3f}) to ({:.3f}, {:.3f})",
                                   content.path, grid.west, grid.south(), grid.east(), grid.north));
    }
    return kept;
}

Mask read_mask_of_land(std::string const& path, Grid const& grid) {
    if (path.empty()) {
        return {};
    }
    Raster<float> const given = io::read_dem(path, {.values = io::CellValues::numbers});
    if (given.width() != grid.width || given.height() != grid.height) {
        throw BadInput(fmt::format("surface.mask = \"{}\" has {}x{} cells, the grid {}x{}", path, given.width(),
                                   given.height(), grid.width, grid.height));
    }
    Mask inside(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        inside[i] = !std::isnan(given[i]) && given[i] != 0.0F ? 1 : 0;
    }
    return inside;
}

namespace {

Raster<float> valued_polygons(Polygons const& polygons, Grid const& grid) {
    Raster<std::int32_t> const number = blend::number_polygons(polygons, grid);
    Raster<float> field(grid, 1.0F);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (number[i] > 0) {
            field[i] = static_cast<float>(polygons.polygons[static_cast<std::size_t>(number[i] - 1)].value);
        }
    }
    return field;
}

} // namespace

Raster<float> read_field(std::string const& path, Grid const& grid, std::string const& what, Run const& run) {
    if (path.empty()) {
        return {};
    }
    Raster<float> field;
    if (io::holds_polygons(path)) {
        field = valued_polygons(io::read_polygons(path, grid.crs, "erodibility", run), grid);
    } else {
        Raster<float> const given = io::warp_to_grid(io::read_dem(path, {.values = io::CellValues::numbers}, run), grid,
                                                     fmt::format("{} = \"{}\"", what, path), run);
        field = Raster<float>(grid, std::numeric_limits<float>::quiet_NaN());
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            Cell const at = given.grid().cell_of(grid.centre(grid.at(i)));
            field[i] = given.grid().contains(at) ? given[at] : field[i];
        }
    }
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (!(field[i] > 0.0F)) {
            Cell const c = grid.at(i);
            throw BadInput(fmt::format("{} = \"{}\" has {} in cell ({}, {}) of the grid: every value must be above "
                                       "0",
                                       what, path, std::isnan(field[i]) ? "none" : fmt::format("{}", field[i]), c.col,
                                       c.row));
        }
    }
    return field;
}

Raster<float> read_dem_in(std::string const& path, std::string const& crs, std::string const& what,
                          std::optional<double> nodata, Run const& run) {
    if (path.empty()) {
        return {};
    }
    Raster<float> dem = io::read_dem(path, {.nodata = nodata}, run);
    Grid lattice;
    lattice.cell_m = io::ground_cell(dem.grid()).side_m;
    lattice.crs = crs;
    return io::warp_to_grid(dem, lattice, fmt::format("{} = \"{}\"", what, path), run);
}

} // namespace thalweg::pipeline
