// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/edge_heights.hpp>

#include <algorithm>

namespace thalweg::surface {

namespace {

constexpr double half_stretch = 24.0; // [finest cells]

/// Means over 2 reach + 1 neighbours on a ring.
std::vector<double> ring_means(std::vector<double> const& values, std::int64_t reach) {
    auto const n = static_cast<std::int64_t>(values.size());
    auto const at = [&](std::int64_t k) { return values[static_cast<std::size_t>(((k % n) + n) % n)]; };
    double sum = 0.0;
    for (std::int64_t k = -reach; k <= reach; ++k) {
        sum += at(k);
    }
    std::vector<double> means(values.size());
    for (std::int64_t k = 0; k < n; ++k) {
        means[static_cast<std::size_t>(k)] = sum / static_cast<double>(2 * reach + 1);
        sum += at(k + reach + 1) - at(k - reach);
    }
    return means;
}

float above_rivers(LandLevel const& level, std::size_t i, float z) {
    for (std::int64_t const offset : level.offsets()) {
        std::int64_t const n = static_cast<std::int64_t>(i) + offset;
        if (n >= 0 && n < level.cells() && level.cover[static_cast<std::size_t>(n)] == Cover::river) {
            z = std::max(z, level.z[static_cast<std::size_t>(n)] + bank_step * level.side);
        }
    }
    return z;
}

} // namespace

EdgeCells edge_cells(LandLevel const& level, NearestRiver const& near) {
    EdgeCells edge;
    std::int64_t const w = level.width;
    std::int64_t const h = level.height;
    auto const nearest = [&](std::size_t i) { return level.rivers.cell[near.number[i]]; };
    auto const put = [&](std::int64_t col, std::int64_t row) {
        auto const i = static_cast<std::size_t>(row * w + col);
        if (level.cover[i] == Cover::sea) {
            edge.ring.push_back(static_cast<std::uint32_t>(i));
            edge.ring_river.push_back(static_cast<std::uint32_t>(i)); // whose height is 0
        } else if (level.cover[i] == Cover::edge) {
            std::int64_t const inner =
                std::clamp<std::int64_t>(row, 1, h - 2) * w + std::clamp<std::int64_t>(col, 1, w - 2);
            edge.ring.push_back(static_cast<std::uint32_t>(i));
            edge.ring_river.push_back(nearest(static_cast<std::size_t>(inner)));
        }
    };
    for (std::int64_t col = 0; col < w - 1; ++col) {
        put(col, 0);
    }
    for (std::int64_t row = 0; row < h - 1; ++row) {
        put(w - 1, row);
    }
    for (std::int64_t col = w - 1; col > 0; --col) {
        put(col, h - 1);
    }
    for (std::int64_t row = h - 1; row > 0; --row) {
        put(0, row);
    }
    each_inner(level, [&](std::size_t i) {
        if (level.cover[i] == Cover::edge) {
            edge.inner.push_back(static_cast<std::uint32_t>(i));
            edge.inner_river.push_back(nearest(i));
        }
    });
    return edge;
}

void set_edge_heights(LandLevel& level, EdgeCells const& edge) {
    for (std::size_t k = 0; k < edge.inner.size(); ++k) {
        level.z[edge.inner[k]] = above_rivers(level, edge.inner[k], level.z[edge.inner_river[k]]);
    }
    if (edge.ring.empty()) {
        return;
    }
    std::vector<double> heights(edge.ring.size());
    std::transform(edge.ring_river.begin(), edge.ring_river.end(), heights.begin(),
                   [&](std::uint32_t river) { return static_cast<double>(level.z[river]); });
    auto const reach = std::max<std::int64_t>(2, static_cast<std::int64_t>(half_stretch / level.side));
    heights = ring_means(ring_means(heights, reach), reach);
    for (std::size_t k = 0; k < heights.size(); ++k) {
        if (level.cover[edge.ring[k]] == Cover::sea) {
            continue;
        }
        level.z[edge.ring[k]] = above_rivers(level, edge.ring[k], static_cast<float>(heights[k]));
    }
}

} // namespace thalweg::surface
