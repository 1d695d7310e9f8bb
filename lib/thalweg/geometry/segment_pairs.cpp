// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/internal/segment_pairs.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include <CGAL/box_intersection_d.h>
#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>

namespace thalweg::geometry {
namespace {

// What CGAL asks of a box, without its own id and pointer: a million polylines have many segments.
class Box {
public:
    using NT = double;
    using ID = std::uint64_t;
    Box(LineSegment segment, Vec2 a, Vec2 b)
        : low_{std::min(a.x, b.x), std::min(a.y, b.y)}, high_{std::max(a.x, b.x), std::max(a.y, b.y)},
          segment_(segment) {}
    static int dimension() { return 2; }
    double min_coord(int d) const { return low_[static_cast<std::size_t>(d)]; }
    double max_coord(int d) const { return high_[static_cast<std::size_t>(d)]; }
    ID id() const { return (ID{segment_.line} << 32U) | segment_.segment; }
    LineSegment segment() const { return segment_; }

private:
    std::array<double, 2> low_;
    std::array<double, 2> high_;
    LineSegment segment_;
};

void add_boxes(std::vector<Vec2> const& line, std::uint32_t number, std::vector<Box>& boxes) {
    for (std::size_t v = 0; v < line.size(); ++v) {
        if (!std::isfinite(line[v].x) || !std::isfinite(line[v].y)) {
            throw BadInput(fmt::format("geometry.crossings: vertex {} of line {} is not finite", v, number));
        }
    }
    std::size_t const before = boxes.size();
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        if (line[i] != line[i + 1]) {
            boxes.emplace_back(LineSegment{number, static_cast<std::uint32_t>(i)}, line[i], line[i + 1]);
        }
    }
    if (boxes.size() == before && line.size() > 1) {
        boxes.emplace_back(LineSegment{number, 0}, line[0], line[0]);
    }
}

} // namespace

void each_close_pair(std::vector<std::vector<Vec2>> const& lines,
                     std::function<void(LineSegment, LineSegment)> const& visit, Run const& run) {
    std::size_t segments = 0;
    for (auto const& line : lines) {
        segments += line.empty() ? 0 : line.size() - 1;
    }
    std::vector<Box> boxes;
    boxes.reserve(segments);
    for (std::size_t l = 0; l < lines.size(); ++l) {
        add_boxes(lines[l], static_cast<std::uint32_t>(l), boxes);
    }
    std::int64_t pairs = 0;
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](Box const& a, Box const& b) {
        if ((++pairs & 0xfff) == 0) {
            run.check();
        }
        visit(a.segment(), b.segment());
    });
}

} // namespace thalweg::geometry
