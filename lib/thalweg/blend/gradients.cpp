// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/blend/gradients.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>

namespace thalweg::blend {
namespace {

using geometry::Measured;

// Of a x + b y + c z.
Vec3 sum(Vec3 const& row, CoordinateGradients const& g) {
    return {row.x * g.x.x + row.y * g.y.x + row.z * g.z.x, row.x * g.x.y + row.y * g.y.y + row.z * g.z.y,
            row.x * g.x.z + row.y * g.y.z + row.z * g.z.z};
}

Vec3 seen(Vec3 const& p, Measured measured) {
    return {p.x, p.y, measured == Measured::in_plan ? 0.0 : p.z};
}

} // namespace

LinearMap rotation(Vec3 axis, double angle_deg, double scale) {
    double const axis_length = norm(axis);
    if (!(axis_length > 0.0) || !std::isfinite(axis_length) || !(std::fabs(angle_deg) <= 1e6) ||
        !std::isfinite(scale)) {
        throw BadParameter(fmt::format("blend.rotation: {} degrees about ({}, {}, {}) with a scale of {}", angle_deg,
                                       axis.x, axis.y, axis.z, scale));
    }
    Vec3 const u = (1.0 / axis_length) * axis;
    double const c = portable::cos(angle_deg * (portable::pi / 180.0));
    double const s = portable::sin(angle_deg * (portable::pi / 180.0));
    double const rest = 1.0 - c; // Rodrigues
    return {scale * Vec3{c + u.x * u.x * rest, u.x * u.y * rest - u.z * s, u.x * u.z * rest + u.y * s},
            scale * Vec3{u.y * u.x * rest + u.z * s, c + u.y * u.y * rest, u.y * u.z * rest - u.x * s},
            scale * Vec3{u.z * u.x * rest - u.y * s, u.z * u.y * rest + u.x * s, c + u.z * u.z * rest}};
}

CoordinateGradients mapped(LinearMap const& map, CoordinateGradients const& gradients) {
    return {sum(map[0], gradients), sum(map[1], gradients), sum(map[2], gradients)};
}

std::array<Vec3, 3> hat_gradients_by_area(Vec3 const& a, Vec3 const& b, Vec3 const& c, Measured measured) {
    Vec3 const ab = seen(b - a, measured);
    Vec3 const ac = seen(c - a, measured);
    Vec3 const normal = cross(ab, ac); // twice the area long
    Vec3 const half = (0.5 / norm(normal)) * normal;
    return {cross(half, ac - ab), cross(half, -1.0 * ac), cross(half, ab)};
}

std::vector<CoordinateGradients> gradients_of(Tin const& parameter, std::vector<Vec3> const& places,
                                              Measured measured) {
    if (places.size() != parameter.vertices.size()) {
        throw BadInput(fmt::format("blend.gradients_of: {} places for a mesh of {} vertices", places.size(),
                                   parameter.vertices.size()));
    }
    geometry::half_cotangents(parameter, measured); // has every triangle area?
    std::vector<CoordinateGradients> gradients;
    gradients.reserve(parameter.triangles.size());
    for (auto const& t : parameter.triangles) {
        auto const corner = [&](std::size_t k) -> Vec3 const& { return parameter.vertices[t[k]]; };
        auto const hats = hat_gradients_by_area(corner(0), corner(1), corner(2), measured);
        double const area =
            0.5 * norm(cross(seen(corner(1) - corner(0), measured), seen(corner(2) - corner(0), measured)));
        // From the first corner's place: the hats add up to 1, their gradients to 0.
        Vec3 const second = (1.0 / area) * (places[t[1]] - places[t[0]]);
        Vec3 const third = (1.0 / area) * (places[t[2]] - places[t[0]]);
        auto const gradient = [&](double at_second, double at_third) {
            return Vec3{at_second * hats[1].x + at_third * hats[2].x, at_second * hats[1].y + at_third * hats[2].y,
                        at_second * hats[1].z + at_third * hats[2].z};
        };
        gradients.push_back({gradient(second.x, third.x), gradient(second.y, third.y), gradient(second.z, third.z)});
    }
    return gradients;
}

} // namespace thalweg::blend
