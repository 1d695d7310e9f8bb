// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/features.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/skeleton/ridges.hpp>

// Described in docs/rebuild.md.

namespace thalweg::make {
namespace {

/// Whether a cell is a river's or lies beside one.
bool at_river(ValleyCells const& valley, std::int64_t cell) {
    Grid const& grid = valley.grid;
    bool found = false;
    cells_around(grid, grid.at(cell), 1, [&](Cell c) { found = found || has_river(valley, grid.index(c)); });
    return found;
}

RidgeOff ridge_off(RiverLine const& ridge, Terrain const& terrain) {
    constexpr std::int64_t least_area = 10; // [cells] of water that crosses
    Raster<float> const& dem = terrain.ground.dem;
    Grid const& grid = dem.grid();
    flow::FlowField const& drainage = terrain.water.drainage;
    std::vector<skeleton::CellOfLine> const cells = skeleton::cells_of_line(ridge.vertices, grid);
    std::map<std::int64_t, bool> on_line;
    for (skeleton::CellOfLine const& c : cells) {
        on_line[c.cell] = true;
    }
    RidgeOff off{ridge.feature, static_cast<std::int64_t>(cells.size()), 0, 0, std::nullopt};
    for (skeleton::CellOfLine const& c : cells) {
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
                                has_river(terrain.bed.valley, dem.grid().index(dem.grid().cell_of(in_plan(p))))});
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
