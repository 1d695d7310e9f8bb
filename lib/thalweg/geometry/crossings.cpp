// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/crossings.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <tuple>
#include <utility>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Exact_rational.h>
#include <CGAL/box_intersection_d.h>

#include <thalweg/core/run/refuse.hpp>

namespace thalweg::geometry {
namespace {

// How two segments of positive length meet.
struct SegmentMeeting {
    enum class Kind {
        none,
        vertex, // at an end of one of them
        proper, // at a point inside both
        stretch // along a stretch
    };
    Kind kind = Kind::none;
    Vec2 first; // where they meet; of a stretch the end with lesser x, then y. Not set if proper
    Vec2 last;  // the other end of a stretch; otherwise equals first
};

// The point where ab and cd cross properly, and its position [0, 1] on each: exact and rounded once.
struct ProperCrossing {
    Vec2 at;
    double on_ab = 0.0;
    double on_cd = 0.0;
};

using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_2;
using Rational = CGAL::Exact_rational;

// Networks mostly meet at common ends, and that is the case in which no filter avoids exact arithmetic.
int side(Vec2 a, Vec2 b, Vec2 p) {
    if (p == a || p == b) {
        return 0;
    }
    return static_cast<int>(CGAL::orientation(Point(a.x, a.y), Point(b.x, b.y), Point(p.x, p.y)));
}

// The double nearest to q. CGAL::to_double only promises a neighbour of it.
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

Vec2 without_minus_zero(Vec2 p) {
    return {p.x + 0.0, p.y + 0.0};
}

// Finds where the segments ab and cd meet: exact, without rational arithmetic.
SegmentMeeting meeting_of(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
    using Kind = SegmentMeeting::Kind;
    int const of_a = side(c, d, a);
    int const of_b = side(c, d, b);
    if (of_a * of_b > 0) {
        return {};
    }
    int const of_c = side(a, b, c);
    int const of_d = side(a, b, d);
    if (of_c * of_d > 0) {
        return {};
    }
    if (of_a == 0 && of_b == 0 && of_c == 0 && of_d == 0) {
        Vec2 const first = std::max(std::min(a, b, before), std::min(c, d, before), before);
        Vec2 const last = std::min(std::max(a, b, before), std::max(c, d, before), before);
        if (before(last, first)) {
            return {};
        }
        return {first == last ? Kind::vertex : Kind::stretch, without_minus_zero(first), without_minus_zero(last)};
    }
    if (of_a != 0 && of_b != 0 && of_c != 0 && of_d != 0) {
        return {Kind::proper, {}, {}};
    }
    Vec2 const p = without_minus_zero(of_a == 0 ? a : of_b == 0 ? b : of_c == 0 ? c : d);
    return {Kind::vertex, p, p};
}

ProperCrossing crossing_of(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
    Rational const sx = Rational(b.x) - Rational(a.x);
    Rational const sy = Rational(b.y) - Rational(a.y);
    Rational const tx = Rational(d.x) - Rational(c.x);
    Rational const ty = Rational(d.y) - Rational(c.y);
    Rational const ox = Rational(c.x) - Rational(a.x);
    Rational const oy = Rational(c.y) - Rational(a.y);
    Rational const area = sx * ty - sy * tx;
    Rational const on_s = (ox * ty - oy * tx) / area;
    Rational const on_t = (ox * sy - oy * sx) / area;
    return {{rounded(Rational(a.x) + on_s * sx), rounded(Rational(a.y) + on_s * sy)}, rounded(on_s), rounded(on_t)};
}

// Position [0, 1] on ab of a point that lies on it, exact and rounded once.
double place_on(Vec2 a, Vec2 b, Vec2 p) {
    if (p == a) {
        return 0.0;
    }
    if (p == b) {
        return 1.0;
    }
    return a.x != b.x ? rounded((Rational(p.x) - Rational(a.x)) / (Rational(b.x) - Rational(a.x)))
                      : rounded((Rational(p.y) - Rational(a.y)) / (Rational(b.y) - Rational(a.y)));
}

// A segment of a polyline: between vertices segment and segment + 1.
struct LineSegment {
    std::uint32_t line = 0;
    std::uint32_t segment = 0;
};

// A box for CGAL without its id and pointer, to save memory: a million polylines have many segments.
class Box {
public:
    using NT = double;
    using ID = std::uint64_t;
    Box(LineSegment segment, Vec2 a, Vec2 b)
        : low_{std::min(a.x, b.x), std::min(a.y, b.y)}, high_{std::max(a.x, b.x), std::max(a.y, b.y)},
          segment_(segment) {}
    static int dimension() { return 2; }
    double min_coord(int d) const { return low_[d]; }
    double max_coord(int d) const { return high_[d]; }
    ID id() const { return (ID{segment_.line} << 32U) | segment_.segment; }
    LineSegment segment() const { return segment_; }

private:
    std::array<double, 2> low_;
    std::array<double, 2> high_;
    LineSegment segment_;
};

struct SouthNorth {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
};

// Adds the boxes of a polyline's segments that touch a band, its northern border not counted.
void add_boxes(std::vector<Vec2> const& line, std::uint32_t number, SouthNorth band, std::vector<Box>& boxes) {
    auto const add = [&](std::uint32_t segment, Vec2 a, Vec2 b) {
        if (std::max(a.y, b.y) >= band.low && std::min(a.y, b.y) < band.high) {
            boxes.emplace_back(LineSegment{number, segment}, a, b);
        }
    };
    bool is_point = line.size() > 1;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        if (line[i] != line[i + 1]) {
            add(static_cast<std::uint32_t>(i), line[i], line[i + 1]);
            is_point = false;
        }
    }
    if (is_point) {
        add(0, line[0], line[0]);
    }
}

// Boxes by the cells of a grid that they touch.
class BoxGrid {
public:
    // Empty, and without use, where the boxes are too uneven for one grid.
    explicit BoxGrid(std::vector<Box> const& boxes) : boxes_(boxes), spans_(boxes.size()) {
        if (set_frame() && set_spans()) {
            fill();
        }
    }

    bool is_filled() const { return !numbers_.empty(); }

    // Calls visit(a, b) once for every two boxes that meet.
    template <class Visit> void each_pair(Visit visit) const {
        for (std::uint32_t row = 0; row < height_; ++row) {
            for (std::uint32_t col = 0; col < width_; ++col) {
                std::size_t const cell = std::size_t{row} * width_ + col;
                for (std::uint32_t i = first_[cell]; i < first_[cell + 1]; ++i) {
                    for (std::uint32_t j = i + 1; j < first_[cell + 1]; ++j) {
                        Span const& a = spans_[numbers_[i]];
                        Span const& b = spans_[numbers_[j]];
                        // Of the cells that two boxes share, the first.
                        if (std::max(a.first_col, b.first_col) == col && std::max(a.first_row, b.first_row) == row &&
                            meet(boxes_[numbers_[i]], boxes_[numbers_[j]])) {
                            visit(boxes_[numbers_[i]], boxes_[numbers_[j]]);
                        }
                    }
                }
            }
        }
    }

private:
    struct Span {
        std::uint32_t first_col;
        std::uint32_t last_col;
        std::uint32_t first_row;
        std::uint32_t last_row;
    };

    static bool meet(Box const& a, Box const& b) {
        return a.min_coord(0) <= b.max_coord(0) && b.min_coord(0) <= a.max_coord(0) &&
               a.min_coord(1) <= b.max_coord(1) && b.min_coord(1) <= a.max_coord(1);
    }

    // Cells of at least twice the mean length of a box; about as many as boxes, or four times as many.
    bool set_frame() {
        constexpr std::size_t most = 1'000'000; // beyond, memory is worth more
        if (boxes_.empty() || boxes_.size() > most) {
            return false;
        }
        low_ = {boxes_.front().min_coord(0), boxes_.front().min_coord(1)};
        Vec2 high = low_;
        double lengths = 0.0;
        for (Box const& box : boxes_) {
            low_ = {std::min(low_.x, box.min_coord(0)), std::min(low_.y, box.min_coord(1))};
            high = {std::max(high.x, box.max_coord(0)), std::max(high.y, box.max_coord(1))};
            lengths += std::max(box.max_coord(0) - box.min_coord(0), box.max_coord(1) - box.min_coord(1));
        }
        auto const count = static_cast<double>(boxes_.size());
        Vec2 const extent = high - low_;
        double const cell = std::max({2.0 * lengths / count, std::sqrt(extent.x * extent.y / (4.0 * count)),
                                      std::max(extent.x, extent.y) / (4.0 * count)});
        per_m_ = 1.0 / cell;
        if (!(per_m_ > 0.0) || !std::isfinite(per_m_) || !std::isfinite(cell)) {
            return false;
        }
        width_ = slot(extent.x) + 1;
        height_ = slot(extent.y) + 1;
        return true;
    }

    std::uint32_t slot(double along) const { return static_cast<std::uint32_t>(along * per_m_); }

    bool set_spans() {
        std::size_t entries = 0;
        for (std::size_t k = 0; k < boxes_.size(); ++k) {
            Box const& box = boxes_[k];
            Span const span{slot(box.min_coord(0) - low_.x), slot(box.max_coord(0) - low_.x),
                            slot(box.min_coord(1) - low_.y), slot(box.max_coord(1) - low_.y)};
            spans_[k] = span;
            entries += std::size_t{span.last_col - span.first_col + 1} * (span.last_row - span.first_row + 1);
            if (entries > 8 * boxes_.size() + 64) {
                return false;
            }
        }
        return true;
    }

    template <class Visit> void each_cell(Span const& span, Visit visit) const {
        for (std::uint32_t row = span.first_row; row <= span.last_row; ++row) {
            for (std::uint32_t col = span.first_col; col <= span.last_col; ++col) {
                visit(std::size_t{row} * width_ + col);
            }
        }
    }

    void fill() {
        first_.assign(std::size_t{width_} * height_ + 1, 0);
        for (Span const& span : spans_) {
            each_cell(span, [&](std::size_t cell) { ++first_[cell]; });
        }
        std::size_t pairs = 0;
        std::uint32_t entries = 0;
        for (std::uint32_t& first : first_) {
            pairs += std::size_t{first} * first / 2;
            entries += first;
            first = entries; // its end, until it is filled from there
        }
        if (pairs > 64 * boxes_.size() + 4096) {
            return;
        }
        numbers_.resize(entries);
        for (std::size_t k = spans_.size(); k-- > 0;) {
            each_cell(spans_[k], [&](std::size_t cell) { numbers_[--first_[cell]] = static_cast<std::uint32_t>(k); });
        }
    }

    std::vector<Box> const& boxes_;
    std::vector<Span> spans_;
    Vec2 low_;
    double per_m_ = 0.0; // cells per metre
    std::uint32_t width_ = 0;
    std::uint32_t height_ = 0;
    std::vector<std::uint32_t> first_; // by cell: its first number, and after the last cell the end
    std::vector<std::uint32_t> numbers_;
};

// What each polyline covers from south to north. Throws BadInput when a coordinate is not finite.
std::vector<SouthNorth> ranges_of(std::vector<std::vector<Vec2>> const& lines) {
    std::vector<SouthNorth> ranges(lines.size());
    for (std::size_t l = 0; l < lines.size(); ++l) {
        for (std::size_t v = 0; v < lines[l].size(); ++v) {
            refuse_if<BadInput>(!is_finite(lines[l][v]), "geometry.crossings", "vertex {} of line {} is not finite", v,
                                l);
            ranges[l] = {std::min(ranges[l].low, lines[l][v].y), std::max(ranges[l].high, lines[l][v].y)};
        }
    }
    return ranges;
}

// Calls visit(a, b) once for every two boxes that meet, in an unspecified order.
template <class Visit> void each_meeting(std::vector<Box>& boxes, Visit const& visit) {
    if (BoxGrid const grid(boxes); grid.is_filled()) {
        grid.each_pair(visit);
    } else {
        CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), visit);
    }
}

// Calls visit once for every two segments whose boxes meet, in an unspecified order: many of them in bands from south
// to north, of which one is in memory. Polylines have finite coordinates; there are fewer than 2^32, of fewer than 2^32
// vertices each. Segments of length 0 are skipped, except the first of a polyline that is one repeated point. Throws
// BadInput when a coordinate is not finite. Source where a grid does not suit: Zomorodian and Edelsbrunner 2000 (CGAL).
void each_close_pair(std::vector<std::vector<Vec2>> const& lines,
                     std::function<void(LineSegment, LineSegment)> const& visit, Run const& run = {}) {
    constexpr std::size_t most_in_band = 1 << 18;
    std::vector<SouthNorth> const ranges = ranges_of(lines);
    std::size_t segments = 0;
    SouthNorth all;
    for (std::size_t l = 0; l < lines.size(); ++l) {
        segments += lines[l].empty() ? 0 : lines[l].size() - 1;
        all = {std::min(all.low, ranges[l].low), std::max(all.high, ranges[l].high)};
    }
    std::size_t const bands = segments / most_in_band + 1;
    double const tall = (all.high - all.low) / static_cast<double>(bands);
    std::int64_t pairs = 0;
    std::vector<Box> boxes;
    for (std::size_t band = 0; band < bands; ++band) {
        double const infinity = std::numeric_limits<double>::infinity();
        double const south = band == 0 ? -infinity : all.low + static_cast<double>(band) * tall;
        double const north = band + 1 == bands ? infinity : all.low + static_cast<double>(band + 1) * tall;
        boxes.clear();
        for (std::size_t l = 0; l < lines.size(); ++l) {
            if (ranges[l].high >= south && ranges[l].low < north) {
                add_boxes(lines[l], static_cast<std::uint32_t>(l), {south, north}, boxes);
            }
        }
        each_meeting(boxes, [&](Box const& a, Box const& b) {
            double const begin = std::max(a.min_coord(1), b.min_coord(1));
            if (begin < south && band > 0) {
                return; // met in a band farther south
            }
            if ((++pairs & 0xfff) == 0) {
                run.check();
            }
            visit(a.segment(), b.segment());
        });
    }
}

using Lines = std::vector<std::vector<Vec2>>;

// Whether the two follow one another in their line, with only repeated vertices between.
bool are_neighbours(Lines const& lines, LineSegment s, LineSegment t) {
    if (s.line != t.line) {
        return false;
    }
    auto const& line = lines[s.line];
    std::size_t const last = std::max(s.segment, t.segment);
    std::size_t v = std::min(s.segment, t.segment) + std::size_t{1};
    while (v < last && line[v] == line[v + 1]) {
        ++v;
    }
    return v == last;
}

class Meetings {
public:
    explicit Meetings(Lines const& lines) : lines_(lines) {}

    void add(LineSegment s, LineSegment t) {
        Vec2 const a = lines_[s.line][s.segment];
        Vec2 const b = lines_[s.line][s.segment + 1];
        Vec2 const c = lines_[t.line][t.segment];
        Vec2 const d = lines_[t.line][t.segment + 1];
        SegmentMeeting const meeting = meeting_of(a, b, c, d);
        switch (meeting.kind) {
        case SegmentMeeting::Kind::none: break;
        case SegmentMeeting::Kind::vertex:
            if (!are_neighbours(lines_, s, t)) {
                add_vertex(s, t, meeting.first);
            }
            break;
        case SegmentMeeting::Kind::stretch:
            add_vertex(s, t, meeting.first);
            add_vertex(s, t, meeting.last);
            break;
        case SegmentMeeting::Kind::proper:
            ProperCrossing const crossing = crossing_of(a, b, c, d);
            found_.push_back({s.line, s.segment, crossing.on_ab, crossing.at});
            found_.push_back({t.line, t.segment, crossing.on_cd, crossing.at});
            break;
        }
    }

    std::vector<Crossing> sorted() {
        // Positions that round to the same value are ordered along the segment's direction.
        auto const key = [&](Crossing const& c) {
            Vec2 const a = lines_[c.line][c.segment];
            Vec2 const b = lines_[c.line][c.segment + 1];
            return std::tuple(c.line, c.segment, c.along, b.x < a.x ? -c.at.x : c.at.x, b.y < a.y ? -c.at.y : c.at.y);
        };
        std::ranges::sort(found_, {}, key);
        found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
        return std::move(found_);
    }

private:
    void add_vertex(LineSegment s, LineSegment t, Vec2 p) {
        for (LineSegment const of : {s, t}) {
            auto const& line = lines_[of.line];
            found_.push_back({of.line, of.segment, place_on(line[of.segment], line[of.segment + 1], p), p});
        }
    }

    Lines const& lines_;
    std::vector<Crossing> found_;
};

bool share_node(Lines const& lines, std::vector<EndNodes> const& nodes, std::size_t line, std::size_t other, Vec2 at) {
    for (std::size_t const end : {0U, 1U}) {
        Vec2 const here = end == 0 ? lines[line].front() : lines[line].back();
        for (std::size_t const other_end : {0U, 1U}) {
            Vec2 const there = other_end == 0 ? lines[other].front() : lines[other].back();
            if (here == at && there == at && nodes[line][end] == nodes[other][other_end]) {
                return true;
            }
        }
    }
    return false;
}

} // namespace

std::vector<Crossing> crossings(Lines const& lines, Run const& run) {
    Meetings meetings(lines);
    each_close_pair(
        lines, [&](LineSegment s, LineSegment t) { meetings.add(s, t); }, run);
    return meetings.sorted();
}

std::vector<Meeting> meetings(Lines const& lines, std::vector<EndNodes> const& nodes, Run const& run) {
    refuse_if<BadInput>(nodes.size() != lines.size(), "geometry.meetings", "{} polylines but nodes of {}", lines.size(),
                        nodes.size());
    std::vector<Meeting> found;
    auto const add = [&](LineSegment s, LineSegment t) {
        if (std::tie(t.line, t.segment) < std::tie(s.line, s.segment)) {
            std::swap(s, t);
        }
        Vec2 const a = lines[s.line][s.segment];
        Vec2 const b = lines[s.line][s.segment + 1];
        Vec2 const c = lines[t.line][t.segment];
        Vec2 const d = lines[t.line][t.segment + 1];
        if (s.line == t.line && s.segment + 1 == t.segment && dot(b - a, d - c) > 0.0) {
            return; // it goes on without folding back
        }
        SegmentMeeting meeting = meeting_of(a, b, c, d);
        switch (meeting.kind) {
        case SegmentMeeting::Kind::none: return;
        case SegmentMeeting::Kind::vertex:
            if (s.line == t.line ? s.segment + 1 == t.segment
                                 : share_node(lines, nodes, s.line, t.line, meeting.first)) {
                return;
            }
            break;
        case SegmentMeeting::Kind::proper: meeting.first = meeting.last = crossing_of(a, b, c, d).at; break;
        case SegmentMeeting::Kind::stretch: break;
        }
        found.push_back({s.line, t.line, s.segment, t.segment, meeting.first, meeting.last});
    };
    each_close_pair(lines, add, run);
    std::ranges::sort(found, {},
                      [](Meeting const& m) { return std::tie(m.line, m.other, m.segment, m.other_segment); });
    return found;
}

} // namespace thalweg::geometry
