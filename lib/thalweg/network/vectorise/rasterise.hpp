// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/stream_network.hpp>
#include <thalweg/core/valley.hpp>

namespace thalweg::network {

struct Rasterised {
    Valley valley;
    std::int64_t lowered_cells = 0; ///< cells shared by several reaches that were lowered to keep each path falling
    double max_lowered_m = 0.0;
};

/// Draws the arcs into cells (Bresenham between vertices, height linear along the arc); where several cover a cell the
/// lowest counts, and what lies downstream of it is lowered to it.
/// Takes: a network inside the grid; the grid's outer edges belong to its outermost cells.
/// Gives: heights that never rise along any arc's cells downstream, compared as the floats they are.
/// Throws: BadInput, naming the arc and the place, when a vertex lies outside the grid or a height is not a number.
/// Source: paper 000, section 3.3; specification 0.3.
Rasterised rasterise(RaisedNetwork const& network, Grid const& grid);

} // namespace thalweg::network
