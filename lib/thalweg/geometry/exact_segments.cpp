// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/internal/exact_segments.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Exact_rational.h>

namespace thalweg::geometry {
namespace {

using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_2;
using Rational = CGAL::Exact_rational;

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

// A common end is the usual case in a network, and the one in which no filter spares the exact arithmetic.
int side(Vec2 a, Vec2 b, Vec2 p) {
    if (p == a || p == b) {
        return 0;
    }
    return static_cast<int>(CGAL::orientation(Point(a.x, a.y), Point(b.x, b.y), Point(p.x, p.y)));
}

Vec2 without_minus_zero(Vec2 p) {
    return {p.x + 0.0, p.y + 0.0};
}

} // namespace

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

} // namespace thalweg::geometry
