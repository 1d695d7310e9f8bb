// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/commands/deform.hpp>

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <thalweg/blend/tin.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/mesh/tin.hpp>
#include <thalweg/io/raster/polygons.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/recipe/read_inputs.hpp>

namespace thalweg::commands {

namespace {

DeformedDem deform_dem(DeformParams const& params, Run const& run) {
    refuse_if<BadParameter>(
        params.rotate_deg != 0.0 || params.axis, "commands.run_deform",
        "--rotate and --axis turn meshes (.2dm, .obj, .off, .glb); a DEM has one height a cell. `thalweg tin` makes a "
        "mesh of it, `thalweg blend --rotate` turns a patch about the vertical");
    refuse_if<BadParameter>(
        !params.source_crs.empty(), "commands.run_deform",
        "--source-crs is for meshes (.2dm, .obj, .off, .glb); assign a DEM its CRS by gdal_edit.py -a_srs");
    io::require_geotiff_name(params.output);
    io::OutputFile file(params.output, params.existing);
    refuse_if<BadParameter>(params.scale == 1.0 && params.handles.empty(), "commands.run_deform",
                            "nothing to do: give a scale or heights to pull to");
    io::DemFile const read = io::read_dem_file(params.target, params.reading, run);
    run.report(read.findings);
    Raster<float> const& target = read.dem;
    Grid const& grid = target.grid();
    Mask const region = recipe::read_part(params.mask, grid, run);
    std::vector<blend::Handle> handles;
    for (Vec3 const& h : params.handles) {
        Cell const cell = grid.cell_of({h.x, h.y});
        refuse_if<BadInput>(!grid.contains(cell), "commands.run_deform",
                            "({}, {}) lies outside {}, which reaches from ({}, {}) to ({}, {})", h.x, h.y,
                            params.target, grid.west, grid.south(), grid.east(), grid.north);
        handles.push_back({cell, h.z});
    }
    run.at(0.0, "deform");
    DeformedDem made{blend::deform(target, region, handles, {.scale = params.scale}, run), read.findings};
    io::write_dem(made.dem, file.staging(), run);
    file.commit();
    return made;
}

/// Whether an odd number of a polygon's rings surrounds a position.
bool surrounds(Polygon const& polygon, Vec2 p) {
    bool inside = false;
    for (std::vector<Vec2> const& ring : polygon.rings) {
        for (std::size_t i = 0; i < ring.size(); ++i) {
            Vec2 const a = ring[i];
            Vec2 const b = ring[(i + 1) % ring.size()];
            if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) {
                inside = !inside;
            }
        }
    }
    return inside;
}

std::vector<char> vertices_inside(Tin const& tin, Polygons const& region) {
    std::vector<char> inside;
    for (Vec3 const& v : tin.vertices) {
        inside.push_back(
            static_cast<char>(std::any_of(region.polygons.begin(), region.polygons.end(), [&](Polygon const& polygon) {
                return surrounds(polygon, {v.x, v.y});
            })));
    }
    return inside;
}

std::uint32_t nearest_inside(Tin const& tin, std::vector<char> const& inside, Vec3 const& handle) {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < inside.size(); ++i) {
        double const away = distance({tin.vertices[i].x, tin.vertices[i].y}, {handle.x, handle.y});
        if (inside[i] != 0 && away < least) {
            least = away;
            best = i;
        }
    }
    return static_cast<std::uint32_t>(best);
}

/// The CRS of a mesh without one: its mask's, with a finding; "": neither has one.
std::string crs_of_mask(DeformParams const& params, std::vector<Finding>& findings) {
    io::PolygonsCrs mask = io::crs_of_polygons(params.mask);
    refuse_if<BadInput>(!mask.crs.empty() && !mask.in_metres, "commands.run_deform",
                        "{} is in {:.60}, {} has no CRS: name it (--source-crs EPSG:n)", params.mask, mask.crs,
                        params.target);
    if (!mask.crs.empty()) {
        findings.push_back({.kind = "no_crs",
                            .text = fmt::format("{} has no CRS: it is taken to be in {:.60}, as {}", params.target,
                                                mask.crs, params.mask),
                            .layer = params.target});
    }
    return std::move(mask.crs);
}

DeformedTin deform_mesh(DeformParams const& params, Run const& run) {
    refuse_if<BadParameter>(params.reading != io::ReadDemParams{}, "commands.run_deform",
                            "--nodata, --band and --encoding are for DEMs: a mesh has no cells");
    Vec3 const axis = params.axis.value_or(Vec3{0.0, 0.0, 1.0});
    refuse_if<BadParameter>(axis == Vec3{}, "commands.run_deform", "--axis 0,0,0 has no direction");
    io::TinFormat const format = io::tin_format("", params.output);
    io::OutputFile output(params.output, params.existing);
    refuse_if<BadParameter>(params.scale == 1.0 && params.rotate_deg == 0.0 && params.handles.empty(),
                            "commands.run_deform", "nothing to do: give a scale, a rotation or heights to pull to");
    io::TinFile file = io::read_tin(params.target, run);
    if (file.crs.empty()) {
        file.crs =
            params.source_crs.empty() ? crs_of_mask(params, file.findings) : io::projected_crs(params.source_crs);
    }
    run.report(file.findings);
    Tin const& tin = file.tin;
    std::vector<char> const inside = vertices_inside(tin, io::read_polygons(params.mask, file.crs, run));
    DeformedTin made;
    made.findings = file.findings;
    made.vertices = std::count(inside.begin(), inside.end(), char{1});
    refuse_if<BadInput>(made.vertices == 0, "commands.run_deform", "no vertex of {} lies in {}", params.target,
                        params.mask);
    bool const turns = params.rotate_deg != 0.0;
    auto const measured = turns ? geometry::Measured::on_surface : geometry::Measured::in_plan;
    blend::LinearMap const map = blend::rotation(axis, params.rotate_deg, params.scale);
    std::vector<blend::CoordinateGradients> guidance = blend::gradients_of(tin, tin.vertices, measured);
    for (std::size_t t = 0; t < guidance.size(); ++t) {
        auto const& corners = tin.triangles[t];
        if (std::all_of(corners.begin(), corners.end(), [&](std::uint32_t v) { return inside[v] != 0; })) {
            guidance[t] = blend::mapped(map, guidance[t]);
        }
    }
    std::vector<blend::FixedVertex> fixed;
    for (std::size_t i = 0; i < inside.size(); ++i) {
        if (inside[i] == 0) {
            fixed.push_back({static_cast<std::uint32_t>(i), tin.vertices[i]});
        }
    }
    for (Vec3 const& handle : params.handles) {
        std::uint32_t const vertex = nearest_inside(tin, inside, handle);
        fixed.push_back({vertex, {tin.vertices[vertex].x, tin.vertices[vertex].y, handle.z}});
    }
    run.at(0.0, "deform");
    blend::PastedTin pasted = blend::paste_tin(tin, guidance, fixed, measured, run);
    made.tin = std::move(pasted.tin);
    made.residual = pasted.residual;
    made.crs = std::move(file.crs);
    io::write_tin(made.tin, made.crs, output.staging(), format, HeightUnit::metre, run);
    output.commit();
    return made;
}

} // namespace

DeformResult run_deform(DeformParams const& params, Run const& run) {
    if (io::holds_tin(params.target)) {
        return deform_mesh(params, run);
    }
    return deform_dem(params, run);
}

} // namespace thalweg::commands
