// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/grid.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg {

/// The cells a polyline runs through: Bresenham between the cells of its vertices, from the first to the last.
/// Takes: vertices inside the grid. Gives: 8-connected cells in order, none twice in a row; empty for no vertices.
/// Where an ideal line halves an edge between two cells the choice depends on the direction of drawing.
/// Throws: BadInput, naming the vertex, when one lies outside the grid or is not a number.
/// Source: Bresenham 1965.
std::vector<Cell> cells_along(std::vector<Vec2> const& line, Grid const& grid);

} // namespace thalweg
