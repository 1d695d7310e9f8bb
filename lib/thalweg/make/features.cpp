// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/features.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/make/internal/features.hpp>

namespace thalweg::make {
namespace {

/// A cell that a line runs through; the next one has a side in common.
struct CellOfLine {
    std::int64_t cell = 0;
    double z_m = 0.0; ///< NaN: none
};

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

double higher(double a, double b) {
    return std::isnan(a) || b > a ? b : a;
}

double cells_between(Grid const& grid, std::int64_t a, std::int64_t b) {
    Cell const from = grid.at(a);
    Cell const to = grid.at(b);
    auto const dx = static_cast<double>(from.col - to.col);
    auto const dy = static_cast<double>(from.row - to.row);
    return std::sqrt(dx * dx + dy * dy);
}

RidgeLines as_ridges(RiverLines const& lines) {
    RidgeLines out;
    for (RiverLine const& line : lines.lines) {
        out.lines.push_back({line.vertices, 0, 0});
    }
    return out;
}

/// Whether a cell is a river's or lies beside one.
bool at_river(Valley const& valley, std::int64_t cell) {
    Grid const& grid = valley.z.grid();
    bool found = false;
    cells_around(grid, grid.at(cell), 1, [&](Cell c) { found = found || !std::isnan(valley.z[c]); });
    return found;
}

RidgeOff ridge_off(RiverLine const& ridge, Terrain const& terrain) {
    constexpr std::int64_t least_area = 10; // [cells] of water that crosses
    Raster<float> const& dem = terrain.ground.dem;
    Grid const& grid = dem.grid();
    flow::FlowField const& drainage = terrain.water.drainage;
    std::vector<CellOfLine> const cells = cells_of_line(ridge.vertices, grid);
    std::map<std::int64_t, bool> on_line;
    for (CellOfLine const& c : cells) {
        on_line[c.cell] = true;
    }
    RidgeOff off{ridge.feature, static_cast<std::int64_t>(cells.size()), 0, 0, std::nullopt};
    for (CellOfLine const& c : cells) {
        if (at_river(terrain.bed.valley, c.cell)) {
            ++off.in_rivers;
            continue;
        }
        bool crossed = false;
        cells_around(grid, grid.at(c.cell), 1, [&](Cell beside) {
            std::int64_t const n = grid.index(beside);
            crossed = crossed ||
                      (!on_line.contains(n) && drainage.receiver(n) == c.cell && drainage.area_cells[n] >= least_area);
        });
        off.crossed += crossed ? 1 : 0;
        if (!std::isnan(c.z_m) && !std::isnan(dem[c.cell])) {
            double const by = std::fabs(static_cast<double>(dem[c.cell]) - c.z_m);
            off.most_m = std::max(off.most_m.value_or(0.0), by);
        }
    }
    return off;
}

} // namespace

std::vector<surface::FeatureCell> feature_cells(FeaturePoints const& points, RiverLines const& ridges,
                                                Grid const& grid) {
    std::map<std::int64_t, surface::FeatureCell> cells;
    for (RiverLine const& ridge : ridges.lines) {
        for (CellOfLine const& c : cells_of_line(ridge.vertices, grid)) {
            surface::FeatureCell& cell = cells[c.cell];
            cell = {c.cell, static_cast<float>(higher(static_cast<double>(cell.z), c.z_m)), true};
        }
    }
    std::map<std::int64_t, double> heights;
    for (Vec3 const& p : points.points) {
        auto const [place, is_new] = heights.try_emplace(grid.index(grid.cell_of(in_plan(p))), p.z);
        place->second = std::max(place->second, p.z);
    }
    for (auto const& [cell, z_m] : heights) {
        cells[cell] = {cell, static_cast<float>(z_m), cells[cell].crest};
    }
    std::vector<surface::FeatureCell> out;
    for (auto const& [number, cell] : cells) {
        out.push_back(cell);
    }
    return out;
}

RidgeLines ridges_with_heights(RiverLines const& lines, recipe::SkeletonRecipe const& wanted, Valley const& valley,
                               Run const& run) {
    RidgeLines ridges = as_ridges(lines);
    Grid const& grid = valley.z.grid();
    Mask rivers(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        rivers[i] = std::isnan(valley.z[i]) ? 0 : 1;
    }
    bool const open = std::ranges::any_of(ridges.lines, [](RidgeLine const& r) { return std::isnan(r.line[0].z); });
    Raster<std::int64_t> const nearest = open ? nearest_cells(rivers, run) : Raster<std::int64_t>{};
    double const most_m =
        wanted.ridge_farthest_m > 0.0 ? wanted.ridge_farthest_m : std::numeric_limits<double>::infinity();
    for (RidgeLine& ridge : ridges.lines) {
        if (!std::isnan(ridge.line.front().z)) {
            continue;
        }
        std::vector<Vec3> line; // with a vertex in each cell, as the distance to rivers is not linear
        for (CellOfLine const& c : cells_of_line(ridge.line, grid)) {
            std::int64_t const river = nearest[c.cell];
            double const far_m = std::min(most_m, cells_between(grid, c.cell, river) * grid.cell_m);
            Vec2 const at = grid.centre(grid.at(c.cell));
            line.push_back({at.x, at.y, static_cast<double>(valley.z[river]) + wanted.ridge_gain * far_m});
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

std::int64_t GivenFeatures::missed() const {
    return std::ranges::count_if(points,
                                 [this](PointOff const& p) { return !(std::fabs(p.z_m - p.asked_m) <= tolerance_m); });
}

std::optional<GivenFeatures> given_features(recipe::Recipe const& recipe, FeaturePoints const& points,
                                            RiverLines const& ridges, Terrain const& terrain) {
    if (!recipe.network || !terrain.has_surface() || (points.points.empty() && ridges.lines.empty())) {
        return std::nullopt;
    }
    Raster<float> const& dem = terrain.ground.dem;
    GivenFeatures given;
    given.points_file = recipe.skeleton->points;
    given.ridges_file = recipe.skeleton->ridge_lines;
    std::int64_t number = 0;
    for (Vec3 const& p : points.points) {
        given.points.push_back({++number, in_plan(p), p.z, static_cast<double>(dem[dem.grid().cell_of(in_plan(p))]),
                                !std::isnan(terrain.bed.valley.z[dem.grid().cell_of(in_plan(p))])});
    }
    for (RiverLine const& ridge : ridges.lines) {
        given.ridges.push_back(ridge_off(ridge, terrain));
    }
    return given;
}

std::string line_of(GivenFeatures const& given) {
    std::string out;
    if (!given.points.empty()) {
        std::vector<double> off;
        for (PointOff const& p : given.points) {
            if (!std::isnan(p.z_m)) {
                off.push_back(std::fabs(p.z_m - p.asked_m));
            }
        }
        std::ranges::sort(off);
        out = fmt::format("{} points", given.points.size());
        out += off.empty()
                   ? ", none on land"
                   : fmt::format(": off by {:.2g} m in the median, {:.2g} m at most", off[off.size() / 2], off.back());
    }
    if (!given.ridges.empty()) {
        std::int64_t cells = 0;
        std::int64_t crossed = 0;
        std::int64_t in_rivers = 0;
        for (RidgeOff const& r : given.ridges) {
            cells += r.cells;
            crossed += r.crossed;
            in_rivers += r.in_rivers;
        }
        out += fmt::format("{}{} ridges of {} cells: water crosses {}, {} lie at rivers", out.empty() ? "" : "; ",
                           given.ridges.size(), cells, crossed, in_rivers);
    }
    return out;
}

} // namespace thalweg::make
