// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/cells_along.hpp>

#include <cstdlib>

#include <fmt/format.h>

#include <thalweg/core/error.hpp>

namespace thalweg {

namespace {

Cell cell_inside(std::vector<Vec2> const& line, std::size_t vertex, Grid const& grid) {
    Vec2 const p = line[vertex];
    // In floating point first: a position far outside has no 64-bit cell.
    if (p.x >= grid.west && p.x <= grid.east() && p.y >= grid.south() && p.y <= grid.north) {
        Cell const cell = grid.cell_of(p);
        if (grid.contains(cell)) {
            return cell;
        }
    }
    throw BadInput(fmt::format("core.cells_along: vertex {} at ({}, {}) lies outside the grid, which spans x {} to {} "
                               "and y {} to {}; enlarge the grid or clip the line",
                               vertex, p.x, p.y, grid.west, grid.east(), grid.south(), grid.north));
}

} // namespace

std::vector<Cell> cells_along(std::vector<Vec2> const& line, Grid const& grid) {
    std::vector<Cell> cells;
    if (line.empty()) {
        return cells;
    }
    Cell at = cell_inside(line, 0, grid);
    cells.push_back(at);
    for (std::size_t i = 1; i < line.size(); ++i) {
        Cell const to = cell_inside(line, i, grid);
        std::int64_t const across = std::abs(to.col - at.col);
        std::int64_t const down = std::abs(to.row - at.row);
        std::int64_t const step_col = at.col < to.col ? 1 : -1;
        std::int64_t const step_row = at.row < to.row ? 1 : -1;
        std::int64_t error = across - down;
        while (!(at == to)) {
            std::int64_t const twice = 2 * error;
            if (twice >= -down) {
                error -= down;
                at.col += step_col;
            }
            if (twice <= across) {
                error += across;
                at.row += step_row;
            }
            cells.push_back(at);
        }
    }
    return cells;
}

} // namespace thalweg
