// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/read_cells.hpp>

#include <fmt/format.h>

#include <thalweg/blend/mask_polygons.hpp>
#include <thalweg/core/cells_along.hpp>
#include <thalweg/core/error.hpp>
#include <thalweg/io/content_of.hpp>
#include <thalweg/io/read_mask.hpp>
#include <thalweg/io/read_polygons.hpp>
#include <thalweg/io/read_rivers.hpp>
#include <thalweg/io/same_frame.hpp>
#include <thalweg/network/clip_lines.hpp>

namespace thalweg::pipeline {

Mask read_part(std::string const& path, Grid const& grid, Run const& run) {
    if (path.empty()) {
        return {};
    }
    return io::holds_polygons(path) ? blend::mask_polygons(io::read_polygons(path, grid.crs, run), grid)
                                    : io::read_mask(path, grid, run);
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
    Mask kept(grid);
    bool any = false;
    for (RiverLine const& line : network::clip_lines(rivers, grid).lines) {
        std::vector<Vec2> plan;
        for (Vec3 const& v : line.vertices) {
            plan.push_back({v.x, v.y});
        }
        for (Cell const c : cells_along(plan, grid, content.path)) {
            kept[c] = 1;
            any = true;
        }
    }
    if (!any) {
        throw BadInput(fmt::format("pipeline.make_blend: no line of {} crosses the target, which reaches from "
                                   "({:.3f}, {:.3f}) to ({:.3f}, {:.3f})",
                                   content.path, grid.west, grid.south(), grid.east(), grid.north));
    }
    return kept;
}

} // namespace thalweg::pipeline
