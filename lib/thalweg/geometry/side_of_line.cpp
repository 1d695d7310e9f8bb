// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/side_of_line.hpp>

#include <cmath>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace thalweg::geometry {
namespace {

// Beyond these, products over- or underflow and the bounds below do not hold.
constexpr double least_magnitude = 1e-280;
constexpr double greatest_magnitude = 1e280;

bool is_exact(double a, double b) {
    double const x = a - b;
    double const b_virtual = a - x;
    double const a_virtual = x + b_virtual;
    return (a - a_virtual) + (b_virtual - b) == 0.0;
}

// What rounding took from a * b (Dekker).
double rest_of_product(double a, double b, double product) {
    constexpr double splitter = 134217729.0; // 2^27 + 1
    double const ca = splitter * a;
    double const a_high = ca - (ca - a);
    double const a_low = a - a_high;
    double const cb = splitter * b;
    double const b_high = cb - (cb - b);
    double const b_low = b - b_high;
    return a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low);
}

int sign(double v) {
    return v > 0.0 ? 1 : v < 0.0 ? -1 : 0;
}

} // namespace

int side_of_line(Vec2 a, Vec2 b, Vec2 p) {
    double const ax = a.x - p.x;
    double const ay = a.y - p.y;
    double const bx = b.x - p.x;
    double const by = b.y - p.y;
    double const left = ax * by;
    double const right = ay * bx;
    double const magnitude = std::fabs(left) + std::fabs(right);
    if (magnitude > least_magnitude && magnitude < greatest_magnitude) {
        constexpr double bound = (3.0 + 16.0 * 0x1p-53) * 0x1p-53;
        if (std::fabs(left - right) > bound * magnitude) {
            return sign(left - right);
        }
        if (is_exact(a.x, p.x) && is_exact(a.y, p.y) && is_exact(b.x, p.x) && is_exact(b.y, p.y)) {
            // Rounding keeps the order of the products: only where they round alike do their rests decide.
            return left != right ? sign(left - right)
                                 : sign(rest_of_product(ax, by, left) - rest_of_product(ay, bx, right));
        }
    }
    using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_2;
    return static_cast<int>(CGAL::orientation(Point(a.x, a.y), Point(b.x, b.y), Point(p.x, p.y)));
}

} // namespace thalweg::geometry
