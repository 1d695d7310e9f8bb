// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include <thalweg/core/grid.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg {

/// Calls visit(cell, k, n) for the cells k = 0 ... n of the line from a to b.
/// \param a,b first and last cell
/// \param visit called as visit(Cell, std::int64_t k, std::int64_t n)
///
/// Source: \cite bresenham1965.
template <class Visit> void walk_cells(Cell a, Cell b, Visit visit) {
    std::int64_t const dx = std::abs(b.col - a.col);
    std::int64_t const dy = std::abs(b.row - a.row);
    std::int64_t const step_x = a.col < b.col ? 1 : -1;
    std::int64_t const step_y = a.row < b.row ? 1 : -1;
    std::int64_t const n = std::max(dx, dy);
    std::int64_t error = dx - dy;
    for (std::int64_t k = 0;; ++k) {
        visit(a, k, n);
        if (k == n) {
            return;
        }
        std::int64_t const twice = 2 * error;
        if (twice > -dy) {
            error -= dy;
            a.col += step_x;
        }
        if (twice < dx) {
            error += dx;
            a.row += step_y;
        }
    }
}

/// Finds the cell of each vertex; a vertex on the grid's outer edge lies in the outermost cell.
/// \param line vertices [m]
/// \param grid every vertex lies inside or on its edge
/// \param what name of the line in messages
/// \return one cell a vertex
/// \throws BadInput naming `what` and the vertex when one is outside the grid or not a number
std::vector<Cell> cells_of_vertices(std::vector<Vec2> const& line, Grid const& grid,
                                    std::string const& what = "a line");

/// Lists the cells of a polyline: walk_cells from vertex to vertex.
/// \param line vertices [m]
/// \param grid every vertex lies inside or on its edge
/// \param what name of the line in messages
/// \return 8-connected cells from the first vertex to the last, no cell twice in a row; empty for an empty line. Where
/// a line passes exactly between two cells, the choice depends on its direction.
/// \throws BadInput as cells_of_vertices
std::vector<Cell> cells_along(std::vector<Vec2> const& line, Grid const& grid, std::string const& what = "a line");

} // namespace thalweg
