// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/nearby.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <tuple>
#include <utility>

#define BOOST_ALLOW_DEPRECATED_HEADERS // rtree.hpp of Boost 1.74 includes one
#include <CGAL/box_intersection_d.h>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/iterator/function_output_iterator.hpp>

namespace thalweg::geometry {

PointGrid::PointGrid(std::vector<Vec2> points, double cell_m) : points_(std::move(points)) {
    low_ = points_.front();
    Vec2 high = low_;
    for (Vec2 const s : points_) {
        low_ = {std::min(low_.x, s.x), std::min(low_.y, s.y)};
        high = {std::max(high.x, s.x), std::max(high.y, s.y)};
    }
    cell_m_ = std::max(cell_m, std::max(high.x - low_.x, high.y - low_.y) / 2000.0);
    width_ = static_cast<std::int64_t>(std::floor((high.x - low_.x) / cell_m_)) + 1;
    height_ = static_cast<std::int64_t>(std::floor((high.y - low_.y) / cell_m_)) + 1;
    first_ = std::vector<std::size_t>(width_ * height_ + 1, 0);
    for (Vec2 const s : points_) {
        ++first_[cell(s) + 1];
    }
    for (std::size_t i = 1; i < first_.size(); ++i) {
        first_[i] += first_[i - 1];
    }
    in_.resize(points_.size());
    std::vector<std::size_t> next = first_;
    for (std::size_t i = 0; i < points_.size(); ++i) {
        in_[next[cell(points_[i])]++] = i;
    }
}

std::size_t PointGrid::nearest(Vec2 p) const {
    auto const col = slot(p.x - low_.x, width_);
    auto const row = slot(p.y - low_.y, height_);
    // A point outside is moved to the border: everything beyond the rings is farther still.
    double const off_x = std::max({low_.x - p.x, p.x - low_.x - static_cast<double>(width_) * cell_m_, 0.0});
    double const off_y = std::max({low_.y - p.y, p.y - low_.y - static_cast<double>(height_) * cell_m_, 0.0});
    double const off = std::max(off_x, off_y);
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::int64_t ring = 0; ring <= std::max(width_, height_); ++ring) {
        double const reached = static_cast<double>(ring - 1) * cell_m_;
        if (ring > 0 && least < std::numeric_limits<double>::infinity() && reached > 0.0 &&
            reached * reached + off * off >= least) {
            break;
        }
        for (std::int64_t r = std::max<std::int64_t>(row - ring, 0); r <= std::min(row + ring, height_ - 1); ++r) {
            bool const edge = r == row - ring || r == row + ring;
            for (std::int64_t c = col - ring; c <= col + ring; c += edge || ring == 0 ? 1 : 2 * ring) {
                if (c < 0 || c >= width_) {
                    continue;
                }
                CellIndex const at = r * width_ + c;
                for (std::size_t k = first_[at]; k < first_[at + 1]; ++k) {
                    Vec2 const d = points_[in_[k]] - p;
                    double const squared = dot(d, d);
                    if (squared < least || (squared == least && in_[k] < best)) {
                        least = squared;
                        best = in_[k];
                    }
                }
            }
        }
    }
    return best;
}

std::int64_t PointGrid::slot(double along, std::int64_t count) const {
    return std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(along / cell_m_)), 0, count - 1);
}

CellIndex PointGrid::cell(Vec2 p) const {
    return slot(p.y - low_.y, height_) * width_ + slot(p.x - low_.x, width_);
}

using TreeBox = boost::geometry::model::box<boost::geometry::model::d2::point_xy<double>>;

struct SegmentIndex::Tree {
    boost::geometry::index::rtree<std::pair<TreeBox, std::size_t>, boost::geometry::index::linear<16>> boxes;
};

SegmentIndex::SegmentIndex(std::vector<std::pair<Vec2, Vec2>> const& segments) {
    std::vector<std::pair<TreeBox, std::size_t>> boxes;
    for (auto const& [a, b] : segments) {
        TreeBox const box{{std::min(a.x, b.x), std::min(a.y, b.y)}, {std::max(a.x, b.x), std::max(a.y, b.y)}};
        boxes.emplace_back(box, boxes.size());
    }
    tree_ = std::make_shared<Tree const>(Tree{{boxes.begin(), boxes.end()}});
}

std::vector<std::size_t> SegmentIndex::near(Vec2 a, Vec2 b, double margin_m) const {
    // Rounding of a place far from the origin must not lose a segment.
    double const wide_m = margin_m + 1e-9 * (std::fabs(a.x) + std::fabs(a.y) + std::fabs(b.x) + std::fabs(b.y));
    TreeBox const around{{std::min(a.x, b.x) - wide_m, std::min(a.y, b.y) - wide_m},
                         {std::max(a.x, b.x) + wide_m, std::max(a.y, b.y) + wide_m}};
    std::vector<std::size_t> numbers;
    tree_->boxes.query(boost::geometry::index::intersects(around),
                       boost::make_function_output_iterator(
                           [&](std::pair<TreeBox, std::size_t> const& found) { numbers.push_back(found.second); }));
    std::ranges::sort(numbers);
    return numbers;
}

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
