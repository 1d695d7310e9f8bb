// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/ridges.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include <thalweg/core/cells.hpp>

namespace thalweg::skeleton {
namespace {

RidgeLines as_ridges(RiverLines const& lines) {
    RidgeLines out;
    for (RiverLine const& line : lines.lines) {
        out.lines.push_back({line.vertices, 0, 0});
    }
    return out;
}

} // namespace

std::vector<CellOfLine> cells_of_line(std::vector<Vec3> const& line, Grid const& grid) {
    std::vector<CellOfLine> out;
    auto const add = [&](Cell c, double z_m) {
        if (std::int64_t const cell = grid.index(c); out.empty() || out.back().cell != cell) {
            out.push_back({cell, z_m});
        }
    };
    for (std::size_t v = 0; v + 1 < line.size(); ++v) {
        Vec2 const from = in_plan(line[v]);
        Vec2 const way = in_plan(line[v + 1]) - from;
        double const length2 = way.x * way.x + way.y * way.y;
        auto const height_at = [&](Cell c) {
            Vec2 const p = grid.centre(c) - from;
            double const share = length2 > 0.0 ? std::clamp((p.x * way.x + p.y * way.y) / length2, 0.0, 1.0) : 0.0;
            return line[v].z + (line[v + 1].z - line[v].z) * share;
        };
        std::optional<Cell> last;
        for (Cell const c : cells_along({from, in_plan(line[v + 1])}, grid, "a ridge")) {
            if (last && last->col != c.col && last->row != c.row) {
                Cell const corner{c.col, last->row};
                add(corner, height_at(corner));
            }
            add(c, height_at(c));
            last = c;
        }
    }
    return out;
}

RidgeLines ridges_with_heights(RiverLines const& lines, Valley const& valley, RidgesParams const& params,
                               Run const& run) {
    RidgeLines ridges = as_ridges(lines);
    Grid const& grid = valley.z.grid();
    Mask rivers(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        rivers[i] = std::isnan(valley.z[i]) ? 0 : 1;
    }
    bool const open = std::ranges::any_of(ridges.lines, [](RidgeLine const& r) { return std::isnan(r.line[0].z); });
    Raster<std::int64_t> const nearest = open ? nearest_cells(rivers, run) : Raster<std::int64_t>{};
    double const most_m = params.farthest_m > 0.0 ? params.farthest_m : std::numeric_limits<double>::infinity();
    for (RidgeLine& ridge : ridges.lines) {
        if (!std::isnan(ridge.line.front().z)) {
            continue;
        }
        std::vector<Vec3> line; // with a vertex in each cell, as the distance to rivers is not linear
        for (CellOfLine const& c : cells_of_line(ridge.line, grid)) {
            std::int64_t const river = nearest[c.cell];
            double const far_cells = std::sqrt(static_cast<double>(squared_cells(grid.at(c.cell), grid.at(river))));
            double const far_m = std::min(most_m, far_cells * grid.cell_m);
            Vec2 const at = grid.centre(grid.at(c.cell));
            line.push_back({at.x, at.y, static_cast<double>(valley.z[river]) + params.gain * far_m});
        }
        if (line.size() == 1) {
            Vec2 const from = in_plan(ridge.line.front());
            Vec2 const to = in_plan(ridge.line.back());
            line = {{from.x, from.y, line[0].z}, {to.x, to.y, line[0].z}};
        }
        ridge.line = std::move(line);
    }
    return ridges;
}

FeaturePoints as_points(RidgeLines const& ridges, Grid const& grid) {
    std::map<std::int64_t, double> heights;
    for (RidgeLine const& ridge : ridges.lines) {
        for (CellOfLine const& c : cells_of_line(ridge.line, grid)) {
            auto const [place, is_new] = heights.try_emplace(c.cell, c.z_m);
            place->second = std::max(place->second, c.z_m);
        }
    }
    FeaturePoints points;
    points.crs = grid.crs;
    for (auto const& [cell, z_m] : heights) {
        Vec2 const at = grid.centre(grid.at(cell));
        points.points.push_back({at.x, at.y, z_m});
    }
    return points;
}

RidgeLines ridges_on(RiverLines const& lines, Raster<float> const& dem) {
    RidgeLines ridges = as_ridges(lines);
    for (RidgeLine& ridge : ridges.lines) {
        for (Vec3& v : ridge.line) {
            v.z = static_cast<double>(dem[dem.grid().cell_of(in_plan(v))]);
        }
    }
    return ridges;
}

} // namespace thalweg::skeleton
