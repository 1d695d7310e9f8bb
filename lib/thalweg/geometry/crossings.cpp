// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/crossings.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Exact_rational.h>
#include <CGAL/box_intersection_d.h>
#include <fmt/format.h>

#include <thalweg/core/error.hpp>

namespace thalweg::geometry {
namespace {

using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_2;
using Rational = CGAL::Exact_rational;

struct Segment {
    std::size_t line = 0;
    std::size_t index = 0;
    std::size_t rank = 0; // place among the segments of its line that have a length
    Vec2 a;
    Vec2 b;
};

std::vector<Segment> segments_of(std::vector<std::vector<Vec2>> const& lines) {
    std::vector<Segment> segments;
    for (std::size_t l = 0; l < lines.size(); ++l) {
        auto const& line = lines[l];
        for (std::size_t v = 0; v < line.size(); ++v) {
            if (!std::isfinite(line[v].x) || !std::isfinite(line[v].y)) {
                throw BadInput(fmt::format("geometry.crossings: vertex {} of line {} is not finite", v, l));
            }
        }
        std::size_t rank = 0;
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            if (line[i] != line[i + 1]) {
                segments.push_back({l, i, rank++, line[i], line[i + 1]});
            }
        }
        if (rank == 0 && line.size() > 1) {
            segments.push_back({l, 0, 0, line[0], line[0]});
        }
    }
    return segments;
}

// The double nearest to q. CGAL::to_double only promises one beside it.
double rounded(Rational const& q) {
    double best = CGAL::to_double(q);
    for (double const side : {-1.0, 1.0}) {
        double const next = std::nextafter(best, side * std::numeric_limits<double>::infinity());
        Rational const gain = CGAL::abs(Rational(best) - q) - CGAL::abs(Rational(next) - q);
        if (gain > 0) {
            best = next;
        }
    }
    return best + 0.0; // never minus zero: equal points have equal bits
}

int side(Vec2 a, Vec2 b, Vec2 p) {
    return static_cast<int>(CGAL::orientation(Point(a.x, a.y), Point(b.x, b.y), Point(p.x, p.y)));
}

bool before(Vec2 a, Vec2 b) {
    return std::tie(a.x, a.y) < std::tie(b.x, b.y);
}

// Place on s of a point that lies on it.
double place(Segment const& s, Vec2 p) {
    if (p == s.a) {
        return 0.0;
    }
    if (p == s.b) {
        return 1.0;
    }
    return s.a.x != s.b.x ? rounded((Rational(p.x) - Rational(s.a.x)) / (Rational(s.b.x) - Rational(s.a.x)))
                          : rounded((Rational(p.y) - Rational(s.a.y)) / (Rational(s.b.y) - Rational(s.a.y)));
}

class Meetings {
public:
    void add(Segment const& s, Segment const& t) {
        bool const neighbours = s.line == t.line && (s.rank + 1 == t.rank || t.rank + 1 == s.rank);
        int const a = side(t.a, t.b, s.a);
        int const b = side(t.a, t.b, s.b);
        int const c = side(s.a, s.b, t.a);
        int const d = side(s.a, s.b, t.b);
        if (a == 0 && b == 0 && c == 0 && d == 0) {
            add_overlap(s, t, neighbours);
        } else if (a * b <= 0 && c * d <= 0 && !neighbours) {
            if (a == 0 || b == 0) {
                add_vertex(s, t, a == 0 ? s.a : s.b);
            } else if (c == 0 || d == 0) {
                add_vertex(s, t, c == 0 ? t.a : t.b);
            } else {
                add_proper(s, t);
            }
        }
    }

    std::vector<Crossing> sorted(std::vector<std::vector<Vec2>> const& lines) {
        // Places that round alike are told apart by how far along the segment's own direction they lie.
        auto const key = [&](Crossing const& c) {
            Vec2 const a = lines[c.line][c.segment];
            Vec2 const b = lines[c.line][c.segment + 1];
            return std::tuple(c.line, c.segment, c.along, b.x < a.x ? -c.at.x : c.at.x, b.y < a.y ? -c.at.y : c.at.y);
        };
        std::ranges::sort(found_, {}, key);
        found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
        return std::move(found_);
    }

private:
    void add_vertex(Segment const& s, Segment const& t, Vec2 p) {
        p = {p.x + 0.0, p.y + 0.0};
        found_.push_back({s.line, s.index, place(s, p), p});
        found_.push_back({t.line, t.index, place(t, p), p});
    }

    void add_overlap(Segment const& s, Segment const& t, bool neighbours) {
        Vec2 const first = std::max(std::min(s.a, s.b, before), std::min(t.a, t.b, before), before);
        Vec2 const last = std::min(std::max(s.a, s.b, before), std::max(t.a, t.b, before), before);
        if (before(last, first) || (neighbours && first == last)) {
            return;
        }
        add_vertex(s, t, first);
        if (first != last) {
            add_vertex(s, t, last);
        }
    }

    void add_proper(Segment const& s, Segment const& t) {
        Rational const sx = Rational(s.b.x) - Rational(s.a.x);
        Rational const sy = Rational(s.b.y) - Rational(s.a.y);
        Rational const tx = Rational(t.b.x) - Rational(t.a.x);
        Rational const ty = Rational(t.b.y) - Rational(t.a.y);
        Rational const ox = Rational(t.a.x) - Rational(s.a.x);
        Rational const oy = Rational(t.a.y) - Rational(s.a.y);
        Rational const area = sx * ty - sy * tx;
        Rational const on_s = (ox * ty - oy * tx) / area;
        Rational const on_t = (ox * sy - oy * sx) / area;
        Vec2 const at{rounded(Rational(s.a.x) + on_s * sx), rounded(Rational(s.a.y) + on_s * sy)};
        found_.push_back({s.line, s.index, rounded(on_s), at});
        found_.push_back({t.line, t.index, rounded(on_t), at});
    }

    std::vector<Crossing> found_;
};

} // namespace

std::vector<Crossing> crossings(std::vector<std::vector<Vec2>> const& lines, Run const& run) {
    using Box = CGAL::Box_intersection_d::Box_with_handle_d<double, 2, Segment const*>;
    auto const segments = segments_of(lines);
    std::vector<Box> boxes;
    boxes.reserve(segments.size());
    for (auto const& s : segments) {
        double low[] = {std::min(s.a.x, s.b.x), std::min(s.a.y, s.b.y)};
        double high[] = {std::max(s.a.x, s.b.x), std::max(s.a.y, s.b.y)};
        boxes.emplace_back(low, high, &s);
    }
    Meetings meetings;
    std::int64_t pairs = 0;
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](Box const& a, Box const& b) {
        if ((++pairs & 0xfff) == 0) {
            run.check();
        }
        meetings.add(*a.handle(), *b.handle());
    });
    return meetings.sorted(lines);
}

} // namespace thalweg::geometry
