// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/commands/blend.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/append.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/mesh/tin.hpp>
#include <thalweg/io/network/read_rivers.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/io/sources/sources.hpp>
#include <thalweg/network/import/prepare_lines.hpp>
#include <thalweg/recipe/read_inputs.hpp>

namespace thalweg::commands {
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
    refuse_if<BadInput>(content.kind != io::FileContent::Kind::lines, "commands.run_blend",
                        "{} holds points: cells to keep come from lines or a raster on the target's grid",
                        content.path);
    RiverLines const rivers = io::read_rivers({content.path, content.layer, "rosgen", {}, grid.crs}, run);
    io::same_crs(rivers.crs, grid.crs, content.path, "the target");
    Mask kept = recipe::cells_under(network::clip_lines(rivers, grid), grid, content.path);
    refuse_if<BadInput>(std::ranges::find(kept.values(), 1) == kept.values().end(), "commands.run_blend",
                        "no line of {} crosses the target, which reaches from ({:.3f}, {:.3f}) to ({:.3f}, {:.3f})",
                        content.path, grid.west, grid.south(), grid.east(), grid.north);
    return kept;
}

make::BlendedDem blend_dems(BlendParams const& params, Run const& run) {
    refuse_if<BadParameter>(
        !params.source_crs.empty(), "commands.run_blend",
        "--source-crs is for meshes (.2dm, .obj, .off, .glb); assign a DEM its CRS by gdal_edit.py -a_srs");
    make::BlendIntoParams const& patch = params.patch;
    io::require_geotiff_name(params.output);
    io::OutputFile file(params.output, params.existing);
    io::DemFile const read = io::read_dem_file(patch.target, patch.reading, run);
    Raster<float> const& target = read.dem;
    make::BlendedDem made = make::blend_into(target, read_kept(patch.keep, target.grid(), run), patch, run);
    made.findings.insert(made.findings.begin(), read.findings.begin(), read.findings.end());
    run.report(made.findings);
    io::write_dem(made.pasted.dem, file.staging(), run);
    file.commit();
    return made;
}

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

void check_mesh_params(make::BlendIntoParams const& params) {
    for (std::string const& path : {params.target, params.source.path}) {
        refuse_if<BadParameter>(
            !io::holds_tin(path), "commands.run_blend",
            "{} is not a mesh (.2dm, .obj, .off, .glb), the other file is; `thalweg tin` makes a mesh of a DEM", path);
    }
    for (auto const& [name, given] :
         {std::pair{"--window", params.window.has_value()}, std::pair{"--mask", !params.mask.path.empty()},
          std::pair{"--keep", !params.keep.empty()}, std::pair{"--feather", params.feather_cells != 0.0},
          std::pair{"--mixed", params.relief == blend::Relief::mixed},
          std::pair{"--fill-holes", params.holes == blend::Holes::fill},
          std::pair{"--nodata, --band or --encoding", params.reading != io::ReadDemParams{}}}) {
        refuse_if<BadParameter>(given, "commands.run_blend",
                                "{} is for DEMs: a mesh is pasted whole, inside its outline", name);
    }
    refuse_if<BadParameter>(!(params.scale > 0.0 && std::isfinite(params.scale)), "commands.run_blend",
                            "a scale of {}; it must be greater than 0", params.scale);
    refuse_if<BadParameter>(!std::isfinite(params.gain), "commands.run_blend", "a gain of {}; it must be finite",
                            params.gain);
    refuse_if<BadParameter>(!(std::fabs(params.rotate_deg) <= 360.0), "commands.run_blend",
                            "a rotation of {} degrees; it lies in [-360, 360]", params.rotate_deg);
    if (params.at && !(std::isfinite(params.at->x) && std::isfinite(params.at->y))) {
        throw BadParameter("commands.run_blend",
                           fmt::format("a place of ({}, {}) is not finite", params.at->x, params.at->y));
    }
}

void place_mesh(Tin& patch, make::BlendIntoParams const& params, Vec2 from, Vec2 to) {
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

BlendedTin blend_meshes(BlendParams const& asked, Run const& run) {
    make::BlendIntoParams const& params = asked.patch;
    check_mesh_params(params);
    io::TinFormat const format = io::tin_format("", asked.output);
    io::OutputFile file(asked.output, asked.existing);
    io::TinFile target = io::read_tin(params.target, run);
    io::TinFile patch = io::read_tin(params.source.path, run);
    std::vector<Finding> findings = target.findings;
    append(findings, patch.findings);
    run.report(findings);
    for (std::string* const crs : {&target.crs, &patch.crs}) {
        if (crs->empty() && !asked.source_crs.empty()) {
            *crs = io::projected_crs(asked.source_crs);
        }
    }
    refuse_if<BadInput>(!target.crs.empty() && !patch.crs.empty() &&
                            !io::same_crs(patch.crs, target.crs, params.source.path, params.target),
                        "commands.run_blend", "{} is in {}, {} in {}; write both meshes in one CRS (thalweg tin --crs)",
                        params.source.path, patch.crs, params.target, target.crs);
    MeshBox const around_target = box_of(target.tin);
    MeshBox const around_patch = box_of(patch.tin);
    BlendedTin made;
    made.findings = std::move(findings);
    made.at = around_patch.middle();
    if (params.at) {
        made.at = *params.at;
    } else if (around_patch.meets(around_target)) {
        made.place = make::PatchPlace::own;
    } else {
        made.place = make::PatchPlace::middle;
        made.at = around_target.middle();
    }
    place_mesh(patch.tin, params, around_patch.middle(), made.at);
    run.at(0.0, "blend");
    made.fused = blend::fuse_tin(target.tin, patch.tin, run);
    made.crs = target.crs.empty() ? std::move(patch.crs) : std::move(target.crs);
    io::write_tin(made.fused.tin, made.crs, file.staging(), format, HeightUnit::metre, run);
    file.commit();
    return made;
}

} // namespace

BlendResult run_blend(BlendParams const& params, Run const& run) {
    if (io::holds_tin(params.patch.target) || io::holds_tin(params.patch.source.path)) {
        return blend_meshes(params, run);
    }
    return blend_dems(params, run);
}

} // namespace thalweg::commands
