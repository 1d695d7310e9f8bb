// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/cells/cells_along.hpp>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>

namespace thalweg {

namespace {

Cell cell_in(Grid const& grid, Vec2 p) {
    Cell c = grid.cell_of(p);
    if (c.col == grid.width && p.x <= grid.east()) {
        --c.col;
    }
    if (c.row == grid.height && p.y >= grid.south()) {
        --c.row;
    }
    return c;
}

} // namespace

std::vector<Cell> cells_of_vertices(std::vector<Vec2> const& line, Grid const& grid, std::string const& what) {
    std::vector<Cell> cells;
    for (std::size_t i = 0; i < line.size(); ++i) {
        // In floating point first: a position far outside has no 64-bit cell.
        bool const within =
            line[i].x >= grid.west && line[i].x <= grid.east() && line[i].y <= grid.north && line[i].y >= grid.south();
        if (!within || !grid.contains(cell_in(grid, line[i]))) {
            throw BadInput(fmt::format("core.cells_along: vertex {} of {} at ({:.3f}, {:.3f}) lies outside the grid "
                                       "(x {:.3f} to {:.3f}, y {:.3f} to {:.3f}); enlarge the grid or clip the rivers",
                                       i, what, line[i].x, line[i].y, grid.west, grid.east(), grid.south(),
                                       grid.north));
        }
        cells.push_back(cell_in(grid, line[i]));
    }
    return cells;
}

std::vector<Cell> cells_along(std::vector<Vec2> const& line, Grid const& grid, std::string const& what) {
    std::vector<Cell> const at = cells_of_vertices(line, grid, what);
    std::vector<Cell> cells;
    for (std::size_t i = 0; i < at.size(); ++i) {
        walk_cells(at[i == 0 ? 0 : i - 1], at[i], [&](Cell c, std::int64_t, std::int64_t) {
            if (cells.empty() || !(cells.back() == c)) {
                cells.push_back(c);
            }
        });
    }
    return cells;
}

} // namespace thalweg
