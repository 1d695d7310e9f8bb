// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/tin.hpp>
#include <thalweg/geometry/triangles.hpp>

namespace test {

using namespace thalweg;

/// Points at random in [0, side)²; with steps > 0 on a lattice of so many places a side, hence with twins.
inline std::vector<Vec3> random_points(std::size_t count, double side, std::uint64_t seed, int steps = 0) {
    std::vector<Vec3> points(count);
    for (std::uint64_t i = 0; auto& p : points) {
        double const u = unit(random_word(seed, 1, i));
        double const v = unit(random_word(seed, 2, i));
        auto const place = [&](double w) {
            return steps > 0 ? static_cast<double>(static_cast<int>(w * steps)) * side / steps : w * side;
        };
        p = {place(u), place(v), 100.0 * unit(random_word(seed, 3, i))};
        ++i;
    }
    return points;
}

/// Twice the area of a triangle in plan.
inline double area2(Vec3 const& a, Vec3 const& b, Vec3 const& c) {
    return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
}

/// Sides by their lower and upper vertex, with the number of triangles that have each.
inline std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides_of(Tin const& tin) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
    for (auto const& t : tin.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            ++sides[std::minmax(t[k], t[(k + 1) % 3])];
        }
    }
    return sides;
}

/// Whether the law of a TIN holds, but for overlaps.
inline bool is_lawful(Tin const& tin) {
    std::set<std::pair<double, double>> places;
    for (Vec3 const& v : tin.vertices) {
        places.emplace(v.x, v.y);
    }
    std::set<std::uint32_t> used;
    for (auto const& t : tin.triangles) {
        used.insert(t.begin(), t.end());
        auto const corner = [&](std::size_t k) { return Vec2{tin.vertices[t[k]].x, tin.vertices[t[k]].y}; };
        if (geometry::side_of_line(corner(0), corner(1), corner(2)) <= 0) {
            return false;
        }
    }
    bool const manifold = std::ranges::all_of(sides_of(tin), [](auto const& side) { return side.second <= 2; });
    return manifold && places.size() == tin.vertices.size() && used.size() == tin.vertices.size();
}

} // namespace test
