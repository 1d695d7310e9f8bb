// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/commands/make_blend.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/gdal/sources.hpp>
#include <thalweg/io/mesh/tin.hpp>
#include <thalweg/io/network/read_rivers.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/network/import/prepare_lines.hpp>
#include <thalweg/pipeline/plan/internal/read_inputs.hpp>

namespace thalweg::pipeline {
namespace {

// Cells of a raster on the grid, or under lines; empty for "". Throws BadInput for points, and when no line crosses the
// grid.
Mask read_kept(std::string const& path, Grid const& grid, Run const& run) {
    if (path.empty()) {
        return {};
    }
    io::FileContent const content = io::content_of(path);
    if (content.kind == io::FileContent::Kind::raster) {
        return io::read_mask(content.path, grid, run);
    }
    refuse_if<BadInput>(
        content.kind != io::FileContent::Kind::lines,
        "pipeline.make_blend: {} holds points: cells to keep come from lines or a raster on the target's grid",
        content.path);
    RiverLines const rivers = io::read_rivers({content.path, content.layer, "rosgen", {}, grid.crs}, run);
    io::same_crs(rivers.crs, grid.crs, "pipeline.make_blend: " + content.path, "the target");
    Mask kept = cells_under(network::clip_lines(rivers, grid), grid, content.path);
    refuse_if<BadInput>(std::ranges::find(kept.values(), 1) == kept.values().end(),
                        "pipeline.make_blend: no line of {} crosses the target, which reaches from ({:.3f}, {:.3f}) to "
                        "({:.3f}, {:.3f})",
                        content.path, grid.west, grid.south(), grid.east(), grid.north);
    return kept;
}

} // namespace

MadeBlend make_blend(MakeBlendParams const& params, Run const& run) {
    Raster<float> const target = io::read_dem(params.target, {.nodata = params.nodata}, run);
    return blend_into(target, read_kept(params.keep, target.grid(), run), params, run);
}

namespace {

struct MeshBox {
    Vec2 low;
    Vec2 high;
    Vec2 middle() const { return {0.5 * (low.x + high.x), 0.5 * (low.y + high.y)}; }
    bool meets(MeshBox const& other) const {
        return low.x < other.high.x && other.low.x < high.x && low.y < other.high.y && other.low.y < high.y;
    }
};

MeshBox box_of(Tin const& tin) {
    constexpr double endless = std::numeric_limits<double>::infinity();
    MeshBox box{{endless, endless}, {-endless, -endless}};
    for (auto const& t : tin.triangles) {
        for (std::uint32_t const v : t) {
            Vec3 const& p = tin.vertices[v];
            box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
            box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
        }
    }
    return box;
}

void check(MakeBlendTinParams const& params) {
    refuse_if<BadParameter>(!(params.scale > 0.0 && std::isfinite(params.scale)),
                            "pipeline.make_blend_tin: a scale of {}; it must be greater than 0", params.scale);
    refuse_if<BadParameter>(!std::isfinite(params.gain), "pipeline.make_blend_tin: a gain of {}; it must be finite",
                            params.gain);
    refuse_if<BadParameter>(!(std::fabs(params.rotate_deg) <= 360.0),
                            "pipeline.make_blend_tin: a rotation of {} degrees; it lies in [-360, 360]",
                            params.rotate_deg);
    if (params.at && !(std::isfinite(params.at->x) && std::isfinite(params.at->y))) {
        throw BadParameter(
            fmt::format("pipeline.make_blend_tin: a place of ({}, {}) is not finite", params.at->x, params.at->y));
    }
}

void place_mesh(Tin& patch, MakeBlendTinParams const& params, Vec2 from, Vec2 to) {
    bool const turns = params.rotate_deg != 0.0 || params.scale != 1.0;
    blend::LinearMap const map = blend::rotation({0.0, 0.0, 1.0}, params.rotate_deg, params.scale);
    for (Vec3& v : patch.vertices) {
        v.z *= params.gain;
        if (turns) {
            double const x = v.x - from.x;
            double const y = v.y - from.y;
            v.x = to.x + map[0].x * x + map[0].y * y;
            v.y = to.y + map[1].x * x + map[1].y * y;
        } else {
            v.x += to.x - from.x;
            v.y += to.y - from.y;
        }
    }
}

} // namespace

MadeBlendTin make_blend_tin(MakeBlendTinParams const& params, Run const& run) {
    check(params);
    io::TinFile target = io::read_tin(params.target, run);
    io::TinFile patch = io::read_tin(params.source, run);
    for (std::string* const crs : {&target.crs, &patch.crs}) {
        if (crs->empty() && !params.source_crs.empty()) {
            *crs = io::projected_crs(params.source_crs);
        }
    }
    refuse_if<BadInput>(
        !target.crs.empty() && !patch.crs.empty() &&
            !io::same_crs(patch.crs, target.crs, "pipeline.make_blend_tin: " + params.source, params.target),
        "pipeline.make_blend_tin: {} is in {}, {} in {}; write both meshes in one CRS (thalweg tin --crs)",
        params.source, patch.crs, params.target, target.crs);
    MeshBox const around_target = box_of(target.tin);
    MeshBox const around_patch = box_of(patch.tin);
    MadeBlendTin made;
    made.at = around_patch.middle();
    if (params.at) {
        made.at = *params.at;
    } else if (around_patch.meets(around_target)) {
        made.place = PatchPlace::own;
    } else {
        made.place = PatchPlace::middle;
        made.at = around_target.middle();
    }
    place_mesh(patch.tin, params, around_patch.middle(), made.at);
    run.at(0.0, "blend");
    made.fused = blend::fuse_tin(target.tin, patch.tin, run);
    made.crs = target.crs.empty() ? std::move(patch.crs) : std::move(target.crs);
    return made;
}

} // namespace thalweg::pipeline
