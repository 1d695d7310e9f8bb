// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/cut_sections.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/draw/internal/main_stem.hpp>

namespace thalweg::draw {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
constexpr double most_points = 4000.0;

Vec2 place_on(MainStem const& stem, double from_out_m) {
    double const where = std::clamp(from_out_m, 0.0, stem.from_out_m.back());
    auto const after = std::lower_bound(stem.from_out_m.begin(), stem.from_out_m.end(), where);
    auto const k = static_cast<std::size_t>(after - stem.from_out_m.begin());
    if (k == 0) {
        return stem.line.front();
    }
    double const step = stem.from_out_m[k] - stem.from_out_m[k - 1];
    double const share = step > 0.0 ? (where - stem.from_out_m[k - 1]) / step : 0.0;
    Vec2 const a = stem.line[k - 1];
    Vec2 const b = stem.line[k];
    return {a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share};
}

/// How far one may go from a place in a direction before leaving the grid.
double room(Grid const& grid, Vec2 from, Vec2 along) {
    auto const until = [](double at, double step, double low, double high) {
        return step > 0.0   ? (high - at) / step
               : step < 0.0 ? (low - at) / step
                            : std::numeric_limits<double>::infinity();
    };
    return std::min(until(from.x, along.x, grid.west, grid.east()), until(from.y, along.y, grid.south(), grid.north));
}

void sample(Section& section, Raster<float> const& dem, double first, double last) {
    double const length = last - first;
    double const steps = std::clamp(std::ceil(length / dem.grid().cell_m), 1.0, most_points);
    for (double k = 0.0; k <= steps; k += 1.0) {
        double const share = k / steps;
        Vec2 const p{section.begin.x + (section.end.x - section.begin.x) * share,
                     section.begin.y + (section.end.y - section.begin.y) * share};
        section.points.push_back({first + length * share, height_at(dem, p)});
    }
}

std::vector<Section> through_the_middle(Raster<float> const& dem) {
    Grid const& grid = dem.grid();
    // Through centres of cells, so that their heights are met.
    Vec2 const middle = grid.centre({grid.width / 2, grid.height / 2});
    Section row{Section::Kind::row, 0.0, {grid.west, middle.y}, {grid.east(), middle.y}, {}};
    Section column{Section::Kind::column, 0.0, {middle.x, grid.south()}, {middle.x, grid.north}, {}};
    sample(row, dem, 0.0, row.end.x - row.begin.x);
    sample(column, dem, 0.0, column.end.y - column.begin.y);
    return {std::move(row), std::move(column)};
}

} // namespace

double height_at(Raster<float> const& dem, Vec2 position) {
    Grid const& grid = dem.grid();
    // Ends of a cut lie on the edge but for rounding.
    double const edge = 0.5 + 1e-6;
    double const col = (position.x - grid.west) / grid.cell_m - 0.5;
    double const row = (grid.north - position.y) / grid.cell_m - 0.5;
    if (!(col >= -edge && row >= -edge && col <= static_cast<double>(grid.width) - 1.0 + edge &&
          row <= static_cast<double>(grid.height) - 1.0 + edge)) {
        return nothing;
    }
    double const c = std::clamp(col, 0.0, static_cast<double>(grid.width - 1));
    double const r = std::clamp(row, 0.0, static_cast<double>(grid.height - 1));
    auto const c0 = static_cast<std::int64_t>(c);
    auto const r0 = static_cast<std::int64_t>(r);
    double const x = c - static_cast<double>(c0);
    double const y = r - static_cast<double>(r0);
    double sum = 0.0;
    for (auto const& [dc, dr, weight] : {std::tuple{0, 0, (1.0 - x) * (1.0 - y)}, std::tuple{1, 0, x * (1.0 - y)},
                                         std::tuple{0, 1, (1.0 - x) * y}, std::tuple{1, 1, x * y}}) {
        if (weight > 0.0) {
            float const z = dem[Cell{c0 + dc, r0 + dr}];
            sum += std::isfinite(z) ? weight * static_cast<double>(z) : nothing;
        }
    }
    return sum;
}

std::vector<Section> cut_sections(Raster<float> const& dem, ElevatedNetwork const* network, NetworkOrders const* orders,
                                  int count) {
    Grid const& grid = dem.grid();
    if (grid.width < 1 || grid.height < 1 || !(grid.cell_m > 0.0)) {
        throw BadInput(fmt::format("draw.cut_sections: a DEM of {} x {} cells of {} m; take one that has some",
                                   grid.width, grid.height, grid.cell_m));
    }
    MainStem const stem = network == nullptr || orders == nullptr ? MainStem{} : main_stem(network->plan, *orders);
    if (stem.line.size() < 2 || !(stem.from_out_m.back() > 0.0)) {
        return through_the_middle(dem);
    }
    double const length = stem.from_out_m.back();
    // The course over a stretch of the river: a step from cell to cell says nothing of where the valley runs.
    double const stretch = std::max(0.06 * length, 4.0 * grid.cell_m);
    double const reach = std::max(0.18 * length, 12.0 * grid.cell_m);
    std::vector<Section> sections;
    for (int k = 0; k < count; ++k) {
        double const where = length * (count == 1 ? 0.5 : 0.9 - 0.8 * k / (count - 1));
        Vec2 const at = place_on(stem, where);
        Vec2 const above = place_on(stem, where + stretch);
        Vec2 const below = place_on(stem, where - stretch);
        double const course = distance(above, below);
        Vec2 const down =
            course > 0.0 ? Vec2{(below.x - above.x) / course, (below.y - above.y) / course} : Vec2{0.0, -1.0};
        Vec2 const right{down.y, -down.x};
        double const left_reach = std::min(reach, room(grid, at, {-right.x, -right.y}));
        double const right_reach = std::min(reach, room(grid, at, right));
        if (!(left_reach >= 0.0 && right_reach >= 0.0 && left_reach + right_reach > 0.0)) {
            continue; // the river is off the DEM here
        }
        Section section;
        section.from_outlet_m = where;
        section.begin = {at.x - right.x * left_reach, at.y - right.y * left_reach};
        section.end = {at.x + right.x * right_reach, at.y + right.y * right_reach};
        sample(section, dem, -left_reach, right_reach);
        sections.push_back(std::move(section));
    }
    return sections.empty() ? through_the_middle(dem) : sections;
}

} // namespace thalweg::draw
