// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

namespace thalweg {

/// Ground position [m] in the coordinate system of the grid: x to the east, y to the north.
struct Vec2 {
    double x = 0.0;
    double y = 0.0;
    friend bool operator==(Vec2 const&, Vec2 const&) = default;
};

/// Ground position and height [m].
struct Vec3 {
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;
    friend bool operator==(Vec3 const&, Vec3 const&) = default;
};

/// The place on the ground, without its height.
constexpr Vec2 plan(Vec3 const& p) {
    return {p.x, p.y};
}

/// Rounded to 1e-6 m, what files hold and nobody can measure; never -0.
inline double rounded(double v) {
    return std::floor(v * 1e6 + 0.5) / 1e6 + 0.0;
}
inline Vec2 rounded(Vec2 p) {
    return {rounded(p.x), rounded(p.y)};
}

/// The order by x, then by y.
constexpr bool before(Vec2 a, Vec2 b) {
    return a.x < b.x || (!(b.x < a.x) && a.y < b.y);
}

/// Twice the area [m2] of the triangle o, a, b: positive where b lies to the left of the line from o to a.
constexpr double cross(Vec2 o, Vec2 a, Vec2 b) {
    return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

/// Distance [m]. Only the square root is used: std::hypot has other bits on other machines.
inline double distance(Vec2 a, Vec2 b) {
    double const dx = a.x - b.x;
    double const dy = a.y - b.y;
    return std::sqrt(dx * dx + dy * dy);
}

} // namespace thalweg
