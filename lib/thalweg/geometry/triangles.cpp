// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/triangles.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Exact_rational.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Weights/utils.h>

#include <thalweg/core/run/refuse.hpp>

namespace thalweg::geometry {
namespace {

// Beyond these limits products over- or underflow and the error bounds below do not hold.
constexpr double least_magnitude = 1e-280;
constexpr double greatest_magnitude = 1e280;

bool is_exact(double a, double b) {
    double const x = a - b;
    double const b_virtual = a - x;
    double const a_virtual = x + b_virtual;
    return (a - a_virtual) + (b_virtual - b) == 0.0;
}

// Rounding error of a * b (Dekker).
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

using Triangle = std::array<std::uint32_t, 3>;

// Spreads the bits of v to every second bit.
std::uint32_t spread(std::uint32_t v) {
    v = (v | (v << 8U)) & 0x00ff00ffU;
    v = (v | (v << 4U)) & 0x0f0f0f0fU;
    v = (v | (v << 2U)) & 0x33333333U;
    return (v | (v << 1U)) & 0x55555555U;
}

// Positions on the Morton curve: 2^16 steps along each side of the square around the vertices.
std::vector<std::uint32_t> curve(std::vector<Vec3> const& vertices) {
    double west = std::numeric_limits<double>::infinity();
    double south = std::numeric_limits<double>::infinity();
    double side = 0.0;
    for (Vec3 const& v : vertices) {
        west = std::min(west, v.x);
        south = std::min(south, v.y);
    }
    for (Vec3 const& v : vertices) {
        side = std::max({side, v.x - west, v.y - south});
    }
    double const scale = side > 0.0 ? 65535.0 / side : 0.0;
    std::vector<std::uint32_t> places;
    places.reserve(vertices.size());
    for (Vec3 const& v : vertices) {
        places.push_back(spread(static_cast<std::uint32_t>((v.x - west) * scale)) |
                         spread(static_cast<std::uint32_t>((v.y - south) * scale)) << 1U);
    }
    return places;
}

struct PlacedTriangle {
    std::uint32_t place;
    Triangle triangle;
};

// Sorts by one half of the position; stable.
void sort_by_half(std::vector<PlacedTriangle>& from, std::vector<PlacedTriangle>& to, unsigned shift) {
    std::vector<std::size_t> next(65537, 0);
    for (PlacedTriangle const& p : from) {
        ++next[((p.place >> shift) & 0xffffU) + 1];
    }
    for (std::size_t k = 1; k < next.size(); ++k) {
        next[k] += next[k - 1];
    }
    for (PlacedTriangle const& p : from) {
        to[next[(p.place >> shift) & 0xffffU]++] = p;
    }
    from.swap(to);
}

using Doubles = CGAL::Simple_cartesian<double>;

template <class Point> std::array<double, 3> of_triangle(Point const& a, Point const& b, Point const& c) {
    namespace weights = CGAL::Weights;
    return {0.5 * weights::cotangent(b, a, c), 0.5 * weights::cotangent(c, b, a), 0.5 * weights::cotangent(a, c, b)};
}

void require_area(Tin const& tin, std::size_t number, Measured measured) {
    auto const& t = tin.triangles[number];
    for (std::uint32_t const v : t) {
        refuse_if<BadInput>(v >= tin.vertices.size(), "geometry.half_cotangents", "triangle {} has vertex {} of {}",
                            number + 1, v + 1, tin.vertices.size());
        Vec3 const& p = tin.vertices[v];
        refuse_if<BadInput>(!is_finite(p), "geometry.half_cotangents", "vertex {} is not finite: ({}, {}, {})", v + 1,
                            p.x, p.y, p.z);
    }
    Vec3 const& a = tin.vertices[t[0]];
    Vec3 const& b = tin.vertices[t[1]];
    Vec3 const& c = tin.vertices[t[2]];
    bool const in_plan = (b.x - a.x) * (c.y - a.y) != (c.x - a.x) * (b.y - a.y);
    bool const upright = (b.x - a.x) * (c.z - a.z) != (c.x - a.x) * (b.z - a.z) ||
                         (b.y - a.y) * (c.z - a.z) != (c.y - a.y) * (b.z - a.z);
    refuse_if<BadInput>(!in_plan && !(upright && measured == Measured::on_surface), "geometry.half_cotangents",
                        "triangle {} at ({}, {}, {}) has no area{}", number + 1, a.x, a.y, a.z,
                        upright ? " in plan" : "");
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
            // Rounding preserves the order of products: only if they round to the same value do the errors decide.
            return left != right ? sign(left - right)
                                 : sign(rest_of_product(ax, by, left) - rest_of_product(ay, bx, right));
        }
    }
    using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_2;
    return static_cast<int>(CGAL::orientation(Point(a.x, a.y), Point(b.x, b.y), Point(p.x, p.y)));
}

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
    double best = CGAL::to_double(z); // which only promises a neighbour of the nearest
    for (double const side : {-1.0, 1.0}) {
        double const next = std::nextafter(best, side * std::numeric_limits<double>::infinity());
        Rational const gain = CGAL::abs(Rational(best) - z) - CGAL::abs(Rational(next) - z);
        if (gain > 0) {
            best = next;
        }
    }
    return best;
}

void put_in_order(Tin& tin) {
    auto const places = curve(tin.vertices);
    std::vector<PlacedTriangle> sorted;
    sorted.reserve(tin.triangles.size());
    for (Triangle t : tin.triangles) {
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
        sorted.push_back({places[t[0]], t});
    }
    std::vector<PlacedTriangle> spare(sorted.size());
    sort_by_half(sorted, spare, 0);
    sort_by_half(sorted, spare, 16);
    for (auto begin = sorted.begin(); begin != sorted.end();) {
        auto const end =
            std::find_if(begin, sorted.end(), [&](PlacedTriangle const& p) { return p.place != begin->place; });
        std::sort(begin, end, [](PlacedTriangle const& a, PlacedTriangle const& b) { return a.triangle < b.triangle; });
        begin = end;
    }
    std::transform(sorted.begin(), sorted.end(), tin.triangles.begin(),
                   [](PlacedTriangle const& p) { return p.triangle; });
}

std::vector<std::array<double, 3>> half_cotangents(Tin const& tin, Measured measured) {
    std::vector<std::array<double, 3>> cotangents;
    cotangents.reserve(tin.triangles.size());
    for (std::size_t i = 0; i < tin.triangles.size(); ++i) {
        require_area(tin, i, measured);
        auto const& t = tin.triangles[i];
        Vec3 const& a = tin.vertices[t[0]];
        // Relative to the first corner: products of coordinates in the millions would lose most digits.
        auto const off = [&](std::uint32_t v) {
            Vec3 const& p = tin.vertices[v];
            return Vec3{p.x - a.x, p.y - a.y, p.z - a.z};
        };
        Vec3 const b = off(t[1]);
        Vec3 const c = off(t[2]);
        cotangents.push_back(
            measured == Measured::in_plan
                ? of_triangle(Doubles::Point_2(0, 0), Doubles::Point_2(b.x, b.y), Doubles::Point_2(c.x, c.y))
                : of_triangle(Doubles::Point_3(0, 0, 0), Doubles::Point_3(b.x, b.y, b.z),
                              Doubles::Point_3(c.x, c.y, c.z)));
    }
    return cotangents;
}

} // namespace thalweg::geometry
