// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/blend/mask_polygons.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>

namespace thalweg::blend {
namespace {

void check(Polygon const& polygon, std::string const& name) {
    for (auto const& ring : polygon.rings) {
        refuse_if<BadInput>(ring.size() < 3, "blend.mask_polygons",
                            "feature {} of {} has a ring of {} vertices; remove it", polygon.feature, name,
                            ring.size());
        for (std::size_t i = 0; i < ring.size(); ++i) {
            if (!is_finite(ring[i])) {
                throw BadInput("blend.mask_polygons",
                               fmt::format("vertex {} of feature {} of {} is not finite: ({}, {})", i + 1,
                                           polygon.feature, name, ring[i].x, ring[i].y));
            }
        }
    }
}

// The first column or row whose centre is at or beyond v (in cells from the edge).
std::int64_t first_from(double v, std::int64_t count) {
    double const cell = std::ceil(v - 0.5);
    return !(cell > 0.0) ? 0 : cell >= static_cast<double>(count) ? count : static_cast<std::int64_t>(cell);
}

/// Where the edges of a polygon cross the middle of each row.
class Crossings {
public:
    explicit Crossings(Grid const& grid) : grid_(grid), columns_(grid.height) {}

    void add_edge(Vec2 a, Vec2 b) {
        if (a.y < b.y) {
            std::swap(a, b); // from north to south, so that both owners of a shared edge cut it at the same positions
        }
        std::int64_t const begin = first_from((grid_.north - a.y) / grid_.cell_m, grid_.height);
        std::int64_t const end = first_from((grid_.north - b.y) / grid_.cell_m, grid_.height);
        for (std::int64_t row = begin; row < end; ++row) {
            double const y = grid_.centre({0, row}).y;
            double const x = a.x + (a.y - y) / (a.y - b.y) * (b.x - a.x);
            columns_[row].push_back((x - grid_.west) / grid_.cell_m);
        }
    }

    template <class T> void fill(Raster<T>& raster, T value) {
        for (std::int64_t row = 0; row < grid_.height; ++row) {
            auto& columns = columns_[row];
            std::ranges::sort(columns);
            for (std::size_t i = 0; i + 1 < columns.size(); i += 2) {
                std::int64_t const end = first_from(columns[i + 1], grid_.width);
                for (std::int64_t col = first_from(columns[i], grid_.width); col < end; ++col) {
                    raster[{col, row}] = value;
                }
            }
            columns.clear();
        }
    }

private:
    Grid const& grid_;
    std::vector<std::vector<double>> columns_;
};

[[noreturn]] void refuse_empty(Polygons const& polygons, Grid const& grid) {
    double west = std::numeric_limits<double>::infinity();
    double east = -west;
    double south = west;
    double north = -west;
    for (Polygon const& polygon : polygons.polygons) {
        for (auto const& ring : polygon.rings) {
            for (Vec2 const& p : ring) {
                west = std::min(west, p.x);
                east = std::max(east, p.x);
                south = std::min(south, p.y);
                north = std::max(north, p.y);
            }
        }
    }
    throw BadInput(
        "blend.mask_polygons",
        fmt::format("the {} polygons of {} lie between ({:.3f}, {:.3f}) and ({:.3f}, {:.3f}) and hold the centre of no "
                    "cell of the target, which reaches from ({:.3f}, {:.3f}) to ({:.3f}, {:.3f})",
                    polygons.polygons.size(), polygons.name, west, south, east, north, grid.west, grid.south(),
                    grid.east(), grid.north));
}

/// Sets the cells in each polygon to the value of its number, counted from 1; others to 0.
template <class T, class Value> Raster<T> burned(Polygons const& polygons, Grid const& grid, Value value_of) {
    Raster<T> raster(grid);
    Crossings crossings(grid);
    std::int32_t number = 0;
    for (Polygon const& polygon : polygons.polygons) {
        check(polygon, polygons.name);
        for (auto const& ring : polygon.rings) {
            for (std::size_t i = 0; i < ring.size(); ++i) {
                crossings.add_edge(ring[i], ring[(i + 1) % ring.size()]);
            }
        }
        crossings.fill(raster, value_of(++number));
    }
    if (std::ranges::all_of(raster.values(), [](T value) { return value == 0; })) {
        refuse_empty(polygons, grid);
    }
    return raster;
}

} // namespace

Raster<std::int32_t> number_polygons(Polygons const& polygons, Grid const& grid) {
    return burned<std::int32_t>(polygons, grid, [](std::int32_t number) { return number; });
}

Mask mask_polygons(Polygons const& polygons, Grid const& grid) {
    return burned<std::uint8_t>(polygons, grid, [](std::int32_t) { return std::uint8_t{1}; });
}

} // namespace thalweg::blend
