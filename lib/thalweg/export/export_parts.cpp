// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/export/internal/export_parts.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/draw/map.hpp>
#include <thalweg/io/raster/dem_derivatives.hpp>
#include <thalweg/report/report.hpp>

namespace thalweg::exports {
namespace {

void fill_holes(Raster<float>& heights, double level) {
    std::ranges::replace_if(
        heights.values(), [](float z) { return std::isnan(z); }, static_cast<float>(level));
}

} // namespace

bool is_mesh(ExportFormat format) {
    return format == ExportFormat::glb || format == ExportFormat::obj || format == ExportFormat::stl;
}

ExportSize fitting(Grid const& grid, std::int64_t longer) {
    std::int64_t const most = std::max(grid.width, grid.height) - 1;
    auto const side = [&](std::int64_t cells) {
        double const share = static_cast<double>(cells - 1) / static_cast<double>(most);
        return std::max<std::int64_t>(
            2, static_cast<std::int64_t>(std::floor(share * static_cast<double>(longer - 1) + 0.5)) + 1);
    };
    return {side(grid.width), side(grid.height)};
}

Lattice sampled(report::Scene const& scene, ExportSize size, ExportResult& made, Run const& run) {
    Raster<float> const& dem = *scene.dem;
    auto const holes = std::ranges::count_if(dem.values(), [](float z) { return std::isnan(z); });
    if (holes == 0) {
        return lattice(dem, size.width, size.height, run);
    }
    made.holes = holes;
    auto const count = [&] { return fmt::format("{} of {} cells", holes, dem.cells()); };
    if (scene.sea) {
        made.hole_m = scene.sea->level_m;
        made.findings.push_back({.kind = "level_sea",
                                 .amount = *made.hole_m,
                                 .text = fmt::format("the sea, {}, lies level at {} m", count(), *made.hole_m)});
        Raster<float> filled = dem;
        fill_holes(filled, *made.hole_m);
        return lattice(filled, size.width, size.height, run);
    }
    made.findings.push_back({.kind = "holes",
                             .amount = static_cast<double>(made.holes),
                             .text = fmt::format("{} have no data: the mesh has holes there", count())});
    return lattice(dem, size.width, size.height, run);
}

std::string texture_of(report::Scene const& scene, Run const& run) {
    run.at(0.0, "texture");
    Raster<float> const& dem = *scene.dem;
    constexpr double longer_px = 2048.0;
    constexpr double least_px = 200.0;
    double const shape = static_cast<double>(dem.width() - 1) / static_cast<double>(dem.height() - 1);
    draw::GroundParams params;
    params.width_px = static_cast<int>(std::max(least_px, std::floor(longer_px * std::min(1.0, shape) + 0.5)));
    Overview const seen = overview(dem, draw::columns_of_ground(dem.grid(), params), 1, run);
    report::ShownLand const land(dem, seen, scene.lakes, run);
    draw::MapSheet sheet = land.sheet();
    sheet.network = scene.network ? &*scene.network : nullptr;
    sheet.orders = scene.network ? &scene.orders : nullptr;
    sheet.areas_m2 = scene.ds_area_m2;
    if (scene.sea) {
        sheet.sea = draw::Sea{scene.sea->is_around};
    }
    return draw::ground(sheet, params).bytes;
}

std::vector<std::vector<Vec3>> rivers_on_mesh(ElevatedNetwork const& network, Lattice const& ground,
                                              LatticeMesh const& mesh, double exaggeration) {
    double const step = std::min(ground.z.grid().cell_m, ground.row_step_m);
    double const lift = 0.1 * step;
    std::vector<std::vector<Vec3>> out;
    for (ArcId arc = 0; arc < network.planform.arc_count(); ++arc) {
        std::vector<Vec2> const& line = network.planform.arc(arc).line;
        std::vector<Vec3> part;
        auto const end_part = [&] {
            if (part.size() > 1) {
                out.push_back(part);
            }
            part.clear();
        };
        auto const add = [&](Vec2 p) {
            double const z = height_on_mesh(ground, p);
            if (std::isnan(z)) {
                end_part();
                return;
            }
            part.push_back({p.x - mesh.origin.x, p.y - mesh.origin.y, (z - mesh.origin.z) * exaggeration + lift});
        };
        for (std::size_t i = 0; i < line.size(); ++i) {
            if (i > 0) { // so dense that lines follow the triangles
                double const pieces = std::floor(distance(line[i - 1], line[i]) / (0.5 * step));
                for (double k = 1.0; k <= pieces; ++k) {
                    add(line[i - 1] + (k / (pieces + 1.0)) * (line[i] - line[i - 1]));
                }
            }
            add(line[i]);
        }
        end_part();
    }
    return out;
}

} // namespace thalweg::exports
