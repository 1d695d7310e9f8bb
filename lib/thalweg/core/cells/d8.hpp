// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <thalweg/core/raster.hpp>

namespace thalweg {

/// Steps of the D8 directions 0..7, clockwise from the east: E, SE, S, SW, W, NW, N, NE (rows count to the south).
inline constexpr std::array<Cell, 8> d8_steps = {
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

/// Reciprocals of the steps' lengths [1/cell].
inline constexpr std::array<double, 8> d8_per_length = {1.0, 0.70710678118654752440, 1.0, 0.70710678118654752440,
                                                        1.0, 0.70710678118654752440, 1.0, 0.70710678118654752440};

/// \param grid the grid
/// \return distance in a raster's values from a cell to its neighbour in each direction.
inline std::array<std::int64_t, 8> d8_offsets(Grid const& grid) {
    std::array<std::int64_t, 8> offsets{};
    for (std::size_t k = 0; k < offsets.size(); ++k) {
        offsets[k] = d8_steps[k].row * grid.width + d8_steps[k].col;
    }
    return offsets;
}

} // namespace thalweg
