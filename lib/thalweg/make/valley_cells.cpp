// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/valley_cells.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace thalweg::make {
namespace {

constexpr float no_river = std::numeric_limits<float>::quiet_NaN();

} // namespace

Raster<float> ValleyCells::raster() const {
    Raster<float> heights(grid, no_river);
    for (std::size_t i = 0; i < cell.size(); ++i) {
        heights[cell[i]] = z[i];
    }
    return heights;
}

ValleyCells valley_cells(Valley const& valley) {
    ValleyCells out{.grid = valley.z.grid()};
    for (std::int64_t i = 0; i < valley.z.cells(); ++i) {
        if (!std::isnan(valley.z[i])) {
            out.cell.push_back(i);
            out.z.push_back(valley.z[i]);
        }
    }
    return out;
}

ValleyCells valley_cells(Grid const& grid, std::vector<std::pair<CellIndex, float>> heights) {
    std::ranges::stable_sort(heights, {}, &std::pair<CellIndex, float>::first);
    ValleyCells out{.grid = grid};
    out.cell.reserve(heights.size());
    out.z.reserve(heights.size());
    for (std::size_t i = 0; i < heights.size(); ++i) {
        auto const& [cell, z] = heights[i];
        bool const is_last = i + 1 == heights.size() || heights[i + 1].first != cell;
        if (is_last && !std::isnan(z)) {
            out.cell.push_back(cell);
            out.z.push_back(z);
        }
    }
    return out;
}

bool has_river(ValleyCells const& valley, CellIndex cell) {
    return std::ranges::binary_search(valley.cell, cell);
}

float height_in(ValleyCells const& valley, CellIndex cell) {
    auto const at = std::ranges::lower_bound(valley.cell, cell);
    bool const is_river = at != valley.cell.end() && *at == cell;
    return is_river ? valley.z[static_cast<std::size_t>(at - valley.cell.begin())] : no_river;
}

} // namespace thalweg::make
