// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/cotangents.hpp>

#include <algorithm>
#include <cmath>

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Weights/utils.h>
#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>

namespace thalweg::geometry {
namespace {

using Doubles = CGAL::Simple_cartesian<double>;

template <class Point> std::array<double, 3> of_triangle(Point const& a, Point const& b, Point const& c) {
    namespace weights = CGAL::Weights;
    return {0.5 * weights::cotangent(b, a, c), 0.5 * weights::cotangent(c, b, a), 0.5 * weights::cotangent(a, c, b)};
}

void require_area(Tin const& tin, std::size_t number, Measured measured) {
    auto const& t = tin.triangles[number];
    for (std::uint32_t const v : t) {
        if (v >= tin.vertices.size()) {
            throw BadInput(fmt::format("geometry.half_cotangents: triangle {} has vertex {} of {}", number + 1, v + 1,
                                       tin.vertices.size()));
        }
        Vec3 const& p = tin.vertices[v];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
            throw BadInput(
                fmt::format("geometry.half_cotangents: vertex {} is not finite: ({}, {}, {})", v + 1, p.x, p.y, p.z));
        }
    }
    Vec3 const& a = tin.vertices[t[0]];
    Vec3 const& b = tin.vertices[t[1]];
    Vec3 const& c = tin.vertices[t[2]];
    bool const in_plan = (b.x - a.x) * (c.y - a.y) != (c.x - a.x) * (b.y - a.y);
    bool const upright = (b.x - a.x) * (c.z - a.z) != (c.x - a.x) * (b.z - a.z) ||
                         (b.y - a.y) * (c.z - a.z) != (c.y - a.y) * (b.z - a.z);
    if (!in_plan && !(upright && measured == Measured::on_surface)) {
        throw BadInput(fmt::format("geometry.half_cotangents: triangle {} at ({}, {}, {}) has no area{}", number + 1,
                                   a.x, a.y, a.z, upright ? " in plan" : ""));
    }
}

} // namespace

std::vector<std::array<double, 3>> half_cotangents(Tin const& tin, Measured measured) {
    std::vector<std::array<double, 3>> cotangents;
    cotangents.reserve(tin.triangles.size());
    for (std::size_t i = 0; i < tin.triangles.size(); ++i) {
        require_area(tin, i, measured);
        auto const& t = tin.triangles[i];
        Vec3 const& a = tin.vertices[t[0]];
        // From the first corner, or coordinates of millions would leave little of their products.
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
