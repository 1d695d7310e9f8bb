// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/measure/drainage.hpp>

/// Private to this room.
namespace thalweg::measure {

/// Distance in a raster's values from a cell to its neighbour in each direction of d8_steps.
inline std::array<std::int64_t, 8> offsets_in(Grid const& grid) {
    std::array<std::int64_t, 8> offsets{};
    for (std::size_t k = 0; k < offsets.size(); ++k) {
        offsets[k] = d8_steps[k].row * grid.width + d8_steps[k].col;
    }
    return offsets;
}

/// A raster in a frame of no data, one cell wide: then leaving the grid is entering no data, and every cell that has
/// data has eight neighbours.
template <class T> Raster<T> framed(Raster<T> const& inner, T no_data) {
    Grid grid = inner.grid();
    grid.width += 2;
    grid.height += 2;
    Raster<T> outer(grid, no_data);
    for (std::int64_t r = 0; r < inner.height(); ++r) {
        auto const row = inner.row(r);
        std::copy(row.begin(), row.end(), outer.row(r + 1).begin() + 1);
    }
    return outer;
}

/// What a frame holds.
template <class T> Raster<T> unframed(Raster<T> const& outer, Grid const& grid) {
    Raster<T> inner(grid);
    for (std::int64_t r = 0; r < grid.height; ++r) {
        auto const row = outer.row(r + 1).subspan(1, static_cast<std::size_t>(grid.width));
        std::copy(row.begin(), row.end(), inner.row(r).begin());
    }
    return inner;
}

} // namespace thalweg::measure
