// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <thalweg/core/raster.hpp>

namespace thalweg {

/// \param inner the raster
/// \param no_data the value of the frame
/// \return a raster in a frame of no data, one cell wide: then leaving the grid is entering no data, and every cell
/// that has data has eight neighbours.
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

/// \param inner the raster
/// \return a raster of heights in such a frame.
inline Raster<float> framed(Raster<float> const& inner) {
    return framed(inner, std::numeric_limits<float>::quiet_NaN());
}

/// \param outer the framed raster
/// \param grid the grid
/// \return what a frame holds.
template <class T> Raster<T> unframed(Raster<T> const& outer, Grid const& grid) {
    Raster<T> inner(grid);
    for (std::int64_t r = 0; r < grid.height; ++r) {
        auto const row = outer.row(r + 1).subspan(1, static_cast<std::size_t>(grid.width));
        std::copy(row.begin(), row.end(), inner.row(r).begin());
    }
    return inner;
}

} // namespace thalweg
