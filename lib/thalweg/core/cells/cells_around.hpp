// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>

#include <thalweg/core/grid.hpp>

namespace thalweg {

/// Calls visit(cell), row by row, for the cells of a square window, clipped to the grid.
/// \param grid clips the window
/// \param c centre of the window
/// \param reach [cells] >= 0, columns and rows on each side of the centre
/// \param visit called as visit(Cell)
template <class Visit> void cells_around(Grid const& grid, Cell c, std::int64_t reach, Visit visit) {
    std::int64_t const north = std::max<std::int64_t>(c.row - reach, 0);
    std::int64_t const south = std::min(c.row + reach, grid.height - 1);
    std::int64_t const west = std::max<std::int64_t>(c.col - reach, 0);
    std::int64_t const east = std::min(c.col + reach, grid.width - 1);
    for (std::int64_t row = north; row <= south; ++row) {
        for (std::int64_t col = west; col <= east; ++col) {
            visit(Cell{col, row});
        }
    }
}

/// Squared distance between the centres of two cells.
/// \param a,b cells
/// \return [cells^2]
inline std::int64_t squared_cells(Cell a, Cell b) {
    return (a.col - b.col) * (a.col - b.col) + (a.row - b.row) * (a.row - b.row);
}

} // namespace thalweg
