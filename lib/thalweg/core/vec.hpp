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

constexpr Vec2 operator+(Vec2 a, Vec2 b) {
    return {a.x + b.x, a.y + b.y};
}
constexpr Vec2 operator-(Vec2 a, Vec2 b) {
    return {a.x - b.x, a.y - b.y};
}
constexpr Vec2 operator*(double s, Vec2 a) {
    return {s * a.x, s * a.y};
}
constexpr double dot(Vec2 a, Vec2 b) {
    return a.x * b.x + a.y * b.y;
}

constexpr Vec3 operator+(Vec3 const& a, Vec3 const& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
constexpr Vec3 operator-(Vec3 const& a, Vec3 const& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
constexpr Vec3 operator*(double s, Vec3 const& a) {
    return {s * a.x, s * a.y, s * a.z};
}
constexpr double dot(Vec3 const& a, Vec3 const& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
constexpr Vec3 cross(Vec3 const& a, Vec3 const& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Length. Only the square root is used: std::hypot has other bits on other machines.
/// \param a a vector
/// \return the length
inline double norm(Vec2 a) {
    return std::sqrt(dot(a, a));
}
inline double norm(Vec3 const& a) {
    return std::sqrt(dot(a, a));
}

/// \param p [m] a position
/// \return the place on the ground, without its height.
constexpr Vec2 plan(Vec3 const& p) {
    return {p.x, p.y};
}

/// \param v [m] a value
/// \return rounded to 1e-6 m, the precision of files; never -0.
inline double rounded(double v) {
    return std::floor(v * 1e6 + 0.5) / 1e6 + 0.0;
}
inline Vec2 rounded(Vec2 p) {
    return {rounded(p.x), rounded(p.y)};
}

/// \param a [m] a position
/// \param b [m] a position
/// \return the order by x, then by y.
constexpr bool before(Vec2 a, Vec2 b) {
    return a.x < b.x || (!(b.x < a.x) && a.y < b.y);
}

/// \param o [m] the first corner
/// \param a [m] the second corner
/// \param b [m] the third corner
/// \return twice the area [m2] of the triangle o, a, b: positive where b lies to the left of the line from o to a.
constexpr double cross(Vec2 o, Vec2 a, Vec2 b) {
    return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

/// \param a [m] a position
/// \param b [m] a position
/// \return distance [m].
inline double distance(Vec2 a, Vec2 b) {
    return norm(a - b);
}

} // namespace thalweg
