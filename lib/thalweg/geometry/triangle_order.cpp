// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/triangle_order.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace thalweg::geometry {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

// Every second bit.
std::uint32_t spread(std::uint32_t v) {
    v = (v | (v << 8U)) & 0x00ff00ffU;
    v = (v | (v << 4U)) & 0x0f0f0f0fU;
    v = (v | (v << 2U)) & 0x33333333U;
    return (v | (v << 1U)) & 0x55555555U;
}

// Places on the curve: 2^16 steps along each side of the square around the vertices.
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

struct Placed {
    std::uint32_t place;
    Triangle triangle;
};

// By one half of the place, keeping the order of equals.
void sort_by_half(std::vector<Placed>& from, std::vector<Placed>& to, unsigned shift) {
    std::vector<std::size_t> next(65537, 0);
    for (Placed const& p : from) {
        ++next[((p.place >> shift) & 0xffffU) + 1];
    }
    for (std::size_t k = 1; k < next.size(); ++k) {
        next[k] += next[k - 1];
    }
    for (Placed const& p : from) {
        to[next[(p.place >> shift) & 0xffffU]++] = p;
    }
    from.swap(to);
}

} // namespace

void put_in_order(Tin& tin) {
    auto const places = curve(tin.vertices);
    std::vector<Placed> sorted;
    sorted.reserve(tin.triangles.size());
    for (Triangle t : tin.triangles) {
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
        sorted.push_back({places[t[0]], t});
    }
    std::vector<Placed> spare(sorted.size());
    sort_by_half(sorted, spare, 0);
    sort_by_half(sorted, spare, 16);
    for (auto begin = sorted.begin(); begin != sorted.end();) {
        auto const end = std::find_if(begin, sorted.end(), [&](Placed const& p) { return p.place != begin->place; });
        std::sort(begin, end, [](Placed const& a, Placed const& b) { return a.triangle < b.triangle; });
        begin = end;
    }
    std::transform(sorted.begin(), sorted.end(), tin.triangles.begin(), [](Placed const& p) { return p.triangle; });
}

} // namespace thalweg::geometry
