// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/report/internal/page.hpp>

#include <thalweg/core/run/error.hpp>

#include <fmt/format.h>

#include <cmath>

namespace thalweg::pipeline {

namespace {

constexpr double steps_a_square = 16.0;
constexpr double farthest = 0x1p29; // products of two differences then stay below 2^62

/// A position in whole steps, x to the east and y to the south.
struct Point {
    std::int64_t x = 0;
    std::int64_t y = 0;
    friend bool operator==(Point const&, Point const&) = default;
};

/// Whether b lies on the straight way from a to c.
bool on_the_way(Point a, Point b, Point c) {
    Point const there{b.x - a.x, b.y - a.y};
    Point const on{c.x - b.x, c.y - b.y};
    return there.x * on.y == there.y * on.x && there.x * on.x + there.y * on.y > 0;
}

std::vector<Point> points_of(std::span<Vec2 const> line, Grid const& grid, double step_m, std::size_t number) {
    if (line.size() < 2) {
        throw BadInput(
            fmt::format("pipeline.page_lines: line {} has {} vertices; give two or more", number, line.size()));
    }
    std::vector<Point> points;
    for (std::size_t i = 0; i < line.size(); ++i) {
        double const x = std::floor((line[i].x - grid.west) / step_m + 0.5);
        double const y = std::floor((grid.north - line[i].y) / step_m + 0.5);
        if (!(std::fabs(x) < farthest && std::fabs(y) < farthest)) {
            throw BadInput(fmt::format("pipeline.page_lines: vertex {} of line {} lies at ({}, {}), far from the grid",
                                       i, number, line[i].x, line[i].y));
        }
        Point const p{static_cast<std::int64_t>(x), static_cast<std::int64_t>(y)};
        if (!points.empty() && points.back() == p) {
            continue;
        }
        if (points.size() > 1 && on_the_way(points[points.size() - 2], points.back(), p)) {
            points.back() = p;
        } else {
            points.push_back(p);
        }
    }
    if (points.size() == 1) {
        points.push_back(points.front());
    }
    return points;
}

void put(std::int64_t difference, std::vector<std::uint8_t>& bytes) {
    auto const magnitude = static_cast<std::uint64_t>(difference < 0 ? -(difference + 1) : difference);
    std::uint64_t rest = 2 * magnitude + (difference < 0 ? 1U : 0U);
    while (rest >= 0x80U) {
        bytes.push_back(static_cast<std::uint8_t>((rest & 0x7FU) | 0x80U));
        rest >>= 7U;
    }
    bytes.push_back(static_cast<std::uint8_t>(rest));
}

} // namespace

PageLines page_lines(std::span<std::span<Vec2 const> const> lines, Grid const& grid) {
    PageLines page;
    page.step = static_cast<double>(page_cells(grid)) / steps_a_square;
    Point last;
    for (std::size_t number = 1; auto const line : lines) {
        std::vector<Point> const points = points_of(line, grid, page.step * grid.cell_m, number++);
        page.vertices.push_back(static_cast<std::int64_t>(points.size()));
        for (Point const p : points) {
            put(p.x - last.x, page.bytes);
            put(p.y - last.y, page.bytes);
            last = p;
        }
    }
    return page;
}

} // namespace thalweg::pipeline
