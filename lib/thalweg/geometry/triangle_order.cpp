// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/triangle_order.hpp>

#include <algorithm>

namespace thalweg::geometry {

std::vector<std::array<std::uint32_t, 3>> in_order(std::vector<std::array<std::uint32_t, 3>> const& triangles,
                                                   std::size_t vertices) {
    // A triangle has few sisters with the same lowest vertex: counting, then sorting each handful, beats one great
    // sort.
    std::vector<std::size_t> begin(vertices + 1, 0);
    for (auto const& t : triangles) {
        ++begin[std::min({t[0], t[1], t[2]}) + std::size_t{1}];
    }
    for (std::size_t v = 0; v < vertices; ++v) {
        begin[v + 1] += begin[v];
    }
    std::vector<std::array<std::uint32_t, 3>> sorted(triangles.size());
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    for (auto t : triangles) {
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
        sorted[next[t[0]]++] = t;
    }
    for (std::size_t v = 0; v < vertices; ++v) {
        std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(begin[v]),
                  sorted.begin() + static_cast<std::ptrdiff_t>(begin[v + 1]));
    }
    return sorted;
}

} // namespace thalweg::geometry
