// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace thalweg {

/// Position in plan [m] in the grid's coordinate system: x eastwards, y northwards.
struct Vec2 {
    double x = 0.0;
    double y = 0.0;
    friend bool operator==(Vec2 const&, Vec2 const&) = default;
};

/// No position.
inline constexpr Vec2 nowhere{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};

/// Position in plan and height [m].
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

/// The Euclidean length. Uses only sqrt, because std::hypot differs between machines.
/// \param a any vector
/// \return >= 0
inline double norm(Vec2 a) {
    return std::sqrt(dot(a, a));
}
inline double norm(Vec3 const& a) {
    return std::sqrt(dot(a, a));
}

/// Whether every coordinate is a number.
inline bool is_finite(Vec2 a) {
    return std::isfinite(a.x) && std::isfinite(a.y);
}
inline bool is_finite(Vec3 const& a) {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// Drops the height.
/// \param p [m]
/// \return position in plan [m]
constexpr Vec2 in_plan(Vec3 const& p) {
    return {p.x, p.y};
}
inline std::vector<Vec2> in_plan(std::vector<Vec3> const& line) {
    std::vector<Vec2> places;
    for (Vec3 const& p : line) {
        places.push_back(in_plan(p));
    }
    return places;
}

/// Rounds to 1e-6 m, the precision of files.
/// \param v [m]
/// \return never -0
inline double rounded(double v) {
    return std::floor(v * 1e6 + 0.5) / 1e6 + 0.0;
}
inline Vec2 rounded(Vec2 p) {
    return {rounded(p.x), rounded(p.y)};
}

/// Orders positions by x, then by y.
/// \param a,b [m]
/// \return true: a precedes b
constexpr bool before(Vec2 a, Vec2 b) {
    return a.x < b.x || (!(b.x < a.x) && a.y < b.y);
}

/// Twice the signed area of a triangle.
/// \param o,a,b corners [m]
/// \return [m2] positive: b lies to the left of the line from o to a
constexpr double cross(Vec2 o, Vec2 a, Vec2 b) {
    return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

/// The distance in plan.
/// \param a,b [m]
/// \return [m]
inline double distance(Vec2 a, Vec2 b) {
    return norm(a - b);
}

/// The length of a polyline in plan.
/// \param line vertices [m]; heights are not read
/// \return [m]
inline double length_in_plan(std::vector<Vec3> const& line) {
    double sum = 0.0;
    for (std::size_t i = 1; i < line.size(); ++i) {
        sum += distance(in_plan(line[i - 1]), in_plan(line[i]));
    }
    return sum;
}

} // namespace thalweg
