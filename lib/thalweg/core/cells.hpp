// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>

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

/// Finds the nearest marked cell of every cell, by exact Euclidean distance.
/// \param marked at least one cell is not 0
/// \return by cell: index of the nearest marked cell; of several equally near, the lowest
/// \throws BadInput when no cell is marked
///
/// Source: \cite meijster2000, with a total order for ties.
Raster<std::int64_t> nearest_cells(Mask const& marked, Run const& run);

} // namespace thalweg
