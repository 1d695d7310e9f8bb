// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/edge_heights.hpp>

#include <algorithm>

namespace thalweg::surface {

namespace {

constexpr double half_stretch = 24.0;   // [finest cells]
constexpr float fall_of_heads = 0.05F;  // a sixth of the steepest tangent
constexpr float fall_of_large = 0.005F; // as rivers fall where the whole grid drains

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

/// By inner cell how low a valley may lie there: a large river falls from it to one of the level.
Cells<float> lowest_valleys(LandLevel const& level) {
    float const each = fall_of_large * level.side;
    std::vector<float> head_start(level.rivers.cell.size());
    std::transform(level.rivers.cell.begin(), level.rivers.cell.end(), head_start.begin(),
                   [&](std::uint32_t cell) { return -level.z[cell] / each; });
    Cells<float> lowest = nearest_river(level, head_start).distance;
    std::transform(lowest.begin(), lowest.end(), lowest.begin(), [&](float far) { return far * each; });
    return lowest;
}

std::vector<double> heights_of(LandLevel const& level, EdgeCells::Part const& part, Cells<float> const& lowest) {
    std::vector<double> heights(part.cell.size());
    for (std::size_t k = 0; k < heights.size(); ++k) {
        float z = level.z[part.river[k]];
        if (!lowest.empty() && level.cover[part.cell[k]] != Cover::sea) {
            z = std::min(z, std::max(z - fall_of_heads * part.far[k], lowest[part.inner[k]]));
        }
        heights[k] = static_cast<double>(z);
    }
    return heights;
}

} // namespace

EdgeCells edge_cells(LandLevel const& level, NearestRiver const& near, Beyond beyond) {
    EdgeCells edge;
    edge.beyond = beyond;
    std::int64_t const w = level.width;
    std::int64_t const h = level.height;
    auto const add = [&](EdgeCells::Part& part, std::size_t i, std::size_t inner) {
        part.cell.push_back(static_cast<std::uint32_t>(i));
        part.inner.push_back(static_cast<std::uint32_t>(inner));
        bool const at_sea = level.cover[i] == Cover::sea; // whose height is 0
        part.river.push_back(at_sea ? static_cast<std::uint32_t>(i) : level.rivers.cell[near.number[inner]]);
        part.far.push_back(at_sea ? 0.0F : near.distance[inner] * level.side);
    };
    auto const put = [&](std::int64_t col, std::int64_t row) {
        auto const i = static_cast<std::size_t>(row * w + col);
        if (level.cover[i] == Cover::sea || level.cover[i] == Cover::edge) {
            add(edge.ring, i,
                static_cast<std::size_t>(std::clamp<std::int64_t>(row, 1, h - 2) * w +
                                         std::clamp<std::int64_t>(col, 1, w - 2)));
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
            add(edge.inside, i, i);
        }
    });
    return edge;
}

void set_edge_heights(LandLevel& level, EdgeCells const& edge) {
    bool const valleys = edge.beyond == Beyond::valleys && !(edge.ring.cell.empty() && edge.inside.cell.empty());
    Cells<float> const lowest = valleys ? lowest_valleys(level) : Cells<float>{};
    std::vector<double> heights = heights_of(level, edge.inside, lowest);
    for (std::size_t k = 0; k < heights.size(); ++k) {
        std::uint32_t const i = edge.inside.cell[k];
        level.z[i] = above_rivers(level, i, static_cast<float>(heights[k]));
    }
    if (edge.ring.cell.empty()) {
        return;
    }
    auto const reach = std::max<std::int64_t>(2, static_cast<std::int64_t>(half_stretch / level.side));
    heights = ring_means(ring_means(heights_of(level, edge.ring, lowest), reach), reach);
    for (std::size_t k = 0; k < heights.size(); ++k) {
        std::uint32_t const i = edge.ring.cell[k];
        if (level.cover[i] != Cover::sea) {
            level.z[i] = above_rivers(level, i, static_cast<float>(heights[k]));
        }
    }
}

} // namespace thalweg::surface
