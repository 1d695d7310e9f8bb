// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <thalweg/core/lattice.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/export/internal/export_parts.hpp>
#include <thalweg/export/internal/print_export.hpp>
#include <thalweg/io/mesh/lattice_files.hpp>
#include <thalweg/report/landmarks.hpp>

namespace thalweg::exports {
namespace {

constexpr double finest_print_mm = 0.1; // steps that printers do not show

void require_print(PrintParams const& params) {
    char const* const who = "export.write_print";
    require_in(who, "longest side", params.longest_mm, Range::between(10.0, 2000.0), "mm");
    require_in(who, "base", params.base_mm, Range::between(0.2, 100.0), "mm");
    require_in(who, "exaggeration", params.exaggeration, Range::above(0.0));
    require_in(who, "vertices", params.most_vertices, Range::between(2.0, 2049.0));
}

Raster<float> without_holes(report::Scene const& scene) {
    Raster<float> dem = *scene.dem;
    auto const is_hole = [](float z) { return std::isnan(z); };
    if (scene.sea) {
        std::ranges::replace_if(dem.values(), is_hole, static_cast<float>(scene.sea->level_m));
    }
    auto const holes = std::ranges::count_if(dem.values(), is_hole);
    refuse_if<BadInput>(holes > 0, "export.write_print",
                        "{} of {} cells have no data: a solid has no holes; close them first (surface.close_gaps)",
                        holes, dem.cells());
    return dem;
}

Lattice lattice_to_print(Raster<float> const& dem, PrintParams const& params, Run const& run) {
    std::int64_t const cells = std::max(dem.width(), dem.height());
    auto const useful = static_cast<std::int64_t>(std::floor(params.longest_mm / finest_print_mm + 0.5)) + 1;
    std::int64_t const longer = std::min({params.most_vertices, useful, cells});
    ExportSize const size = fitting(dem.grid(), longer);
    return lattice(dem, size.width, size.height, run);
}

/// Two digits: what a user would type.
double in_round_numbers(double factor) {
    double step = 1.0;
    for (; factor / step >= 100.0; step *= 10.0) {
    }
    for (; factor / step < 10.0; step /= 10.0) {
    }
    return std::floor(factor / step + 0.5) * step;
}

std::vector<Finding> print_findings(PrintExport const& made, PrintParams const& params) {
    std::vector<Finding> findings{{.kind = "print_size",
                                   .amount = std::max(made.size_mm.x, made.size_mm.y),
                                   .text = fmt::format("printed at 1 : {:.0f}, {:.1f} x {:.1f} x {:.1f} mm", made.scale,
                                                       made.size_mm.x, made.size_mm.y, made.size_mm.z)}};
    constexpr double low_mm = 2.0;
    constexpr double well_seen_mm = 10.0;
    if (made.relief_mm > 0.0 && made.relief_mm < low_mm) {
        double const factor = params.exaggeration * well_seen_mm / made.relief_mm;
        findings.push_back(
            {.kind = "low_relief",
             .amount = made.relief_mm,
             .text = fmt::format("the relief is only {:.2g} mm high: --exaggeration {:.6g} makes it about {} mm",
                                 made.relief_mm, in_round_numbers(factor), well_seen_mm)});
    } else if (made.relief_mm == 0.0) {
        findings.push_back({.kind = "flat", .text = "the terrain is flat"});
    }
    return findings;
}

} // namespace

PrintExport write_print(report::Scene const& scene, PrintParams const& params, io::OutputFolder const& out,
                        Run const& run) {
    require_print(params);
    refuse_if<BadInput>(!scene.dem, "export.write_print", "there is no DEM");
    Raster<float> const dem = without_holes(scene);
    refuse_if<BadInput>(dem.width() < 2 || dem.height() < 2, "export.write_print",
                        "the DEM has {} x {} cells: at least 2 x 2 are needed", dem.width(), dem.height());
    Lattice const ground = lattice_to_print(dem, params, run);
    Vec2 const extent = ground.extent_m();
    double const mm_per_m = params.longest_mm / std::max(extent.x, extent.y);
    LatticeMesh mesh = solid_mesh(ground, params.base_mm / (mm_per_m * params.exaggeration), params.exaggeration, run);
    Vec3 const corner{-0.5 * extent.x, -0.5 * extent.y, mesh.vertices.back().z}; // the base is last
    for (Vec3& v : mesh.vertices) {
        v = mm_per_m * (v - corner);
    }
    constexpr char const* name = "terrain.stl";
    io::write_stl(mesh, out.path(name), run, "millimetres");

    PrintExport made;
    auto const range = *report::height_range(ground.z);
    made.relief_mm = (range.second - range.first) * params.exaggeration * mm_per_m;
    made.size_mm = {mm_per_m * extent.x, mm_per_m * extent.y, params.base_mm + made.relief_mm};
    constexpr double mm_in_m = 1000.0;
    made.scale = mm_in_m / mm_per_m;
    made.width = ground.z.width();
    made.height = ground.z.height();
    made.vertices = static_cast<std::int64_t>(mesh.vertices.size());
    made.triangles = static_cast<std::int64_t>(mesh.triangles.size());
    made.files = {name};
    made.findings = print_findings(made, params);
    return made;
}

} // namespace thalweg::exports
