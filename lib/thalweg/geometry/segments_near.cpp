// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/segments_near.hpp>

#include <algorithm>
#include <cstdint>
#include <tuple>

#include <CGAL/box_intersection_d.h>

namespace thalweg::geometry {

Foot foot_on(Vec2 a, Vec2 b, Vec2 p) {
    double const dx = b.x - a.x;
    double const dy = b.y - a.y;
    double const squared = dx * dx + dy * dy;
    double const t = squared > 0.0 ? ((p.x - a.x) * dx + (p.y - a.y) * dy) / squared : 0.0;
    if (t <= 0.0) {
        return {0.0, a};
    }
    return t >= 1.0 ? Foot{1.0, b} : Foot{t, {a.x + t * dx, a.y + t * dy}};
}

bool is_spike(Vec2 before, Vec2 tip, Vec2 after, double near_m) {
    Vec2 base = before;
    Vec2 other = after;
    if (distance(tip, other) < distance(tip, base)) {
        std::swap(base, other);
    }
    double const turn = (base.x - tip.x) * (other.x - tip.x) + (base.y - tip.y) * (other.y - tip.y);
    return turn > 0.0 && distance(tip, base) > near_m && distance(base, foot_on(tip, other, base).at) <= near_m;
}

std::vector<std::vector<NearSegment>> segments_near(std::vector<Vec2> const& points,
                                                    std::vector<std::vector<Vec2>> const& lines, double distance_m,
                                                    Run const& run) {
    using Box =
        CGAL::Box_intersection_d::Box_with_handle_d<double, 2, std::size_t, CGAL::Box_intersection_d::ID_EXPLICIT>;
    std::vector<Box> around;
    for (std::size_t i = 0; i < points.size(); ++i) {
        double low[] = {points[i].x - distance_m, points[i].y - distance_m};
        double high[] = {points[i].x + distance_m, points[i].y + distance_m};
        around.emplace_back(low, high, i);
    }
    std::vector<Box> boxes;
    std::vector<NearSegment> segments;
    for (std::size_t l = 0; l < lines.size(); ++l) {
        for (std::size_t i = 0; i + 1 < lines[l].size(); ++i) {
            Vec2 const a = lines[l][i];
            Vec2 const b = lines[l][i + 1];
            double low[] = {std::min(a.x, b.x), std::min(a.y, b.y)};
            double high[] = {std::max(a.x, b.x), std::max(a.y, b.y)};
            boxes.emplace_back(low, high, segments.size());
            segments.push_back({l, i});
        }
    }
    std::vector<std::vector<NearSegment>> found(points.size());
    std::int64_t pairs = 0;
    auto const note = [&](Box const& point, Box const& box) {
        if ((++pairs & 0xfff) == 0) {
            run.check();
        }
        Vec2 const p = points[point.handle()];
        NearSegment const s = segments[box.handle()];
        auto const& line = lines[s.line];
        if (distance(p, foot_on(line[s.segment], line[s.segment + 1], p).at) <= distance_m) {
            found[point.handle()].push_back(s);
        }
    };
    CGAL::box_intersection_d(around.begin(), around.end(), boxes.begin(), boxes.end(), note);
    for (auto& near : found) {
        std::ranges::sort(near, {}, [](NearSegment const& s) { return std::tuple(s.line, s.segment); });
    }
    return found;
}

} // namespace thalweg::geometry
