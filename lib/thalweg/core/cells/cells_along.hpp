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

/// Calls visit(cell, k, n) for the cells k = 0 ... n from a to b.
/// \param a first cell
/// \param b last cell
/// \param visit the function to call
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

/// The grid's outer edges belong to its outermost cells.
/// \param line the vertices
/// \param grid the grid
/// \param what what it is, for messages
/// \return the cells of a line's vertices, one each.
/// \throws BadInput naming `what` and the vertex, when one lies outside the grid or is not a number
std::vector<Cell> cells_of_vertices(std::vector<Vec2> const& line, Grid const& grid,
                                    std::string const& what = "a line");

/// The cells a polyline runs through: walk_cells between those of its vertices, from the first to the last.
/// \param line the vertices
/// \param grid the grid
/// \param what what it is, for messages
/// \return 8-connected cells in order, none twice in a row; empty for no vertices. Where an ideal line halves an edge
/// between two cells the choice depends on the direction of drawing.
/// \throws Error as cells_of_vertices
std::vector<Cell> cells_along(std::vector<Vec2> const& line, Grid const& grid, std::string const& what = "a line");

} // namespace thalweg
