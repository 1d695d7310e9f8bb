// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <thalweg/core/raster.hpp>

namespace thalweg {

/// Steps of the D8 directions 0..7, clockwise from the east: E, SE, S, SW, W, NW, N, NE (rows count southwards).
inline constexpr std::array<Cell, 8> d8_steps = {
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

/// Reciprocals of the lengths of the steps [1/cell].
inline constexpr std::array<double, 8> d8_per_length = {1.0, 0.70710678118654752440, 1.0, 0.70710678118654752440,
                                                        1.0, 0.70710678118654752440, 1.0, 0.70710678118654752440};

/// Index offsets of the eight neighbours.
/// \param grid gives the width of a row
/// \return by D8 direction: the neighbour's index minus the cell's
inline std::array<std::int64_t, 8> d8_offsets(Grid const& grid) {
    std::array<std::int64_t, 8> offsets{};
    for (std::size_t k = 0; k < offsets.size(); ++k) {
        offsets[k] = d8_steps[k].row * grid.width + d8_steps[k].col;
    }
    return offsets;
}

} // namespace thalweg
