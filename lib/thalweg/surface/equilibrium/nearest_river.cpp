// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/nearest_river.hpp>

#include <limits>
#include <utility>

namespace thalweg::surface {

namespace {

/// Steps to the neighbours that a pass in row order has met before.
constexpr std::array<std::size_t, 4> before = {4, 5, 6, 7};

void take_nearer(NearestRiver& near, std::size_t i, std::size_t from, float length) {
    if (near.distance[from] + length < near.distance[i]) {
        near.distance[i] = near.distance[from] + length;
        near.number[i] = near.number[from];
    }
}

} // namespace

NearestRiver nearest_river(LandLevel const& level, std::vector<float> const& head_start, Cells<std::uint32_t> memory) {
    auto const cells = static_cast<std::size_t>(level.cells());
    NearestRiver near{Cells<float>(cells, std::numeric_limits<float>::infinity()), std::move(memory)};
    near.number.assign(cells, NearestRiver::none);
    for (std::size_t n = 0; n < level.rivers.cell.size(); ++n) {
        near.distance[level.rivers.cell[n]] = head_start.empty() ? 0.0F : -head_start[n];
        near.number[level.rivers.cell[n]] = static_cast<std::uint32_t>(n);
    }
    auto const offsets = level.offsets();
    auto const width = static_cast<std::size_t>(level.width);
    auto const height = static_cast<std::size_t>(level.height);
    for (std::size_t row = 1; row + 1 < height; ++row) {
        for (std::size_t i = row * width + 1; i + 1 < (row + 1) * width; ++i) {
            for (std::size_t const k : before) {
                take_nearer(near, i, moved(i, offsets[k]), step_lengths[k]);
            }
        }
    }
    for (std::size_t row = height - 2; row > 0; --row) {
        for (std::size_t i = (row + 1) * width - 2; i > row * width; --i) {
            for (std::size_t const k : before) {
                take_nearer(near, i, moved(i, -offsets[k]), step_lengths[k]);
            }
        }
    }
    return near;
}

} // namespace thalweg::surface
