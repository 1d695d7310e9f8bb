// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/dla/internal/walk.hpp>

#include <algorithm>
#include <cmath>

namespace thalweg::network {

namespace {

struct Direction {
    double x;
    double y;
};

Direction uniform_direction(RandomStream& random) {
    for (;;) {
        std::uint64_t const word = random.word();
        // Half a step off the integers keeps the four quadrants alike and the origin out.
        double const u = (static_cast<double>(static_cast<std::uint32_t>(word)) + 0.5) * 0x1p-31 - 1.0;
        double const v = (static_cast<double>(word >> 32) + 0.5) * 0x1p-31 - 1.0;
        double const square = u * u + v * v;
        if (square <= 1.0) {
            return {(u * u - v * v) / square, 2.0 * u * v / square};
        }
    }
}

Site nearest_site(double x, double y) {
    return {static_cast<std::int32_t>(std::floor(x + 0.5)), static_cast<std::int32_t>(std::floor(y + 0.5))};
}

} // namespace

LaunchCircle launch_circle(double cluster_radius) {
    LaunchCircle circle;
    circle.birth = cluster_radius + 4.0;
    circle.far = static_cast<std::int32_t>(std::max(1.5 * circle.birth, circle.birth + 24.0));
    return circle;
}

Site born(LaunchCircle const& circle, RandomStream& random) {
    Direction const w = uniform_direction(random);
    return nearest_site(circle.birth * w.x, circle.birth * w.y);
}

Site back_from_afar(LaunchCircle const& circle, Site from, RandomStream& random) {
    Direction const w = uniform_direction(random);
    double const scale = circle.birth / static_cast<double>(squared(from));
    double const ax = scale * from.x;
    double const ay = scale * from.y;
    double const top_x = w.x + ax;
    double const top_y = w.y + ay;
    double const low_x = 1.0 + ax * w.x + ay * w.y;
    double const low_y = ax * w.y - ay * w.x;
    double const length = circle.birth / (low_x * low_x + low_y * low_y);
    return nearest_site(length * (top_x * low_x + top_y * low_y), length * (top_y * low_x - top_x * low_y));
}

} // namespace thalweg::network
