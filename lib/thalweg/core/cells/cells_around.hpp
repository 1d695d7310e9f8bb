// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>

#include <thalweg/core/grid.hpp>

namespace thalweg {

/// Calls visit(cell), row by row, for the cells of the grid that lie at most `reach` columns and rows from one.
/// \param grid the grid
/// \param c the cell
/// \param reach [cells] >= 0
/// \param visit the function to call
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

/// \param a a cell
/// \param b a cell
/// \return [cells^2]
inline std::int64_t squared_cells(Cell a, Cell b) {
    return (a.col - b.col) * (a.col - b.col) + (a.row - b.row) * (a.row - b.row);
}

} // namespace thalweg
