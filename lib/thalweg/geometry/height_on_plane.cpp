// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/height_on_plane.hpp>

#include <cmath>
#include <limits>

#include <CGAL/Exact_rational.h>

namespace thalweg::geometry {

double height_on_plane(Vec3 const& a, Vec3 const& b, Vec3 const& c, Vec2 p) {
    using Rational = CGAL::Exact_rational;
    auto const difference = [](double v, double from) { return Rational(Rational(v) - Rational(from)); };
    Rational const bx = difference(b.x, a.x);
    Rational const by = difference(b.y, a.y);
    Rational const cx = difference(c.x, a.x);
    Rational const cy = difference(c.y, a.y);
    Rational const px = difference(p.x, a.x);
    Rational const py = difference(p.y, a.y);
    Rational const area = bx * cy - cx * by;
    Rational const of_b = (px * cy - cx * py) / area;
    Rational const of_c = (bx * py - px * by) / area;
    Rational const z = Rational(a.z) + of_b * difference(b.z, a.z) + of_c * difference(c.z, a.z);
    double best = CGAL::to_double(z); // which only promises one beside the nearest
    for (double const side : {-1.0, 1.0}) {
        double const next = std::nextafter(best, side * std::numeric_limits<double>::infinity());
        Rational const gain = CGAL::abs(Rational(best) - z) - CGAL::abs(Rational(next) - z);
        if (gain > 0) {
            best = next;
        }
    }
    return best;
}

} // namespace thalweg::geometry
