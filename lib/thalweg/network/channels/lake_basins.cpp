// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/channels/internal/lake_basins.hpp>

#include <cstddef>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>

namespace thalweg::network {

Raster<std::int32_t> kept_apart(Raster<std::int32_t> const& labels) {
    Grid const& grid = labels.grid();
    Raster<std::int32_t> out = labels;
    for (std::int64_t i = 0; i < labels.cells(); ++i) {
        if (labels[i] < 0) {
            Vec2 const at = grid.centre(grid.at(i));
            throw BadInput(fmt::format("network.flood_lakes: the label {} at ({:.3f}, {:.3f}) is below 0; number lakes "
                                       "from 1",
                                       labels[i], at.x, at.y));
        }
        if (labels[i] == 0) {
            continue;
        }
        bool gives_way = grid.on_border(grid.at(i));
        each_neighbour(grid, i, [&](std::int64_t n) { gives_way |= labels[n] > 0 && labels[n] < labels[i]; });
        out[i] = gives_way ? 0 : labels[i];
    }
    return out;
}

std::vector<Basin> basins_of(Raster<std::int32_t> const& labels, Raster<std::int32_t> left) {
    std::unordered_map<std::int32_t, std::int64_t> cut; // looked up only, never walked
    for (std::int64_t i = 0; i < labels.cells(); ++i) {
        cut[labels[i]] += labels[i] != left[i] ? 1 : 0;
    }
    std::vector<Basin> out;
    for (std::int64_t i = 0; i < left.cells(); ++i) {
        std::int32_t const label = left[i];
        if (label == 0) {
            continue;
        }
        Basin& basin = out.emplace_back(Basin{label, std::exchange(cut[label], 0), {i}});
        left[i] = 0;
        for (std::size_t k = 0; k < basin.cells.size(); ++k) {
            each_neighbour(labels.grid(), basin.cells[k], [&](std::int64_t n) {
                if (left[n] == label) {
                    left[n] = 0;
                    basin.cells.push_back(n);
                }
            });
        }
    }
    return out;
}

} // namespace thalweg::network
