// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <thalweg/core/raster.hpp>

namespace thalweg {

/// Steps of the D8 directions 0..7, clockwise from the east: E, SE, S, SW, W, NW, N, NE (rows count to the south).
inline constexpr std::array<Cell, 8> d8_steps = {
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

/// Reciprocals of the steps' lengths [1/cell].
inline constexpr std::array<double, 8> d8_per_length = {1.0, 0.70710678118654752440, 1.0, 0.70710678118654752440,
                                                        1.0, 0.70710678118654752440, 1.0, 0.70710678118654752440};

/// Distance in a raster's values from a cell to its neighbour in each direction.
inline std::array<std::int64_t, 8> d8_offsets(Grid const& grid) {
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
    grid.west -= grid.cell_m;
    grid.north += grid.cell_m;
    Raster<T> outer(grid, no_data);
    for (std::int64_t r = 0; r < inner.height(); ++r) {
        auto const row = inner.row(r);
        std::copy(row.begin(), row.end(), outer.row(r + 1).begin() + 1);
    }
    return outer;
}

/// A raster of heights in such a frame.
inline Raster<float> framed(Raster<float> const& inner) {
    return framed(inner, std::numeric_limits<float>::quiet_NaN());
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

} // namespace thalweg
