// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <thalweg/core/raster.hpp>

namespace thalweg {

/// Adds a frame one cell wide, so that every inner cell has eight neighbours.
/// \param inner any raster
/// \param no_data value of the frame's cells
/// \return a raster two cells wider and higher, its grid extended by one cell on each side
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

/// Adds a frame of NaN.
/// \param inner heights [m]
/// \return as framed(inner, NaN)
inline Raster<float> framed(Raster<float> const& inner) {
    return framed(inner, std::numeric_limits<float>::quiet_NaN());
}

/// Removes a frame.
/// \param outer a framed raster
/// \param grid grid of the result: the raster's before framed
/// \return the cells inside the frame
template <class T> Raster<T> unframed(Raster<T> const& outer, Grid const& grid) {
    Raster<T> inner(grid);
    for (std::int64_t r = 0; r < grid.height; ++r) {
        auto const row = outer.row(r + 1).subspan(1, static_cast<std::size_t>(grid.width));
        std::copy(row.begin(), row.end(), inner.row(r).begin());
    }
    return inner;
}

} // namespace thalweg
