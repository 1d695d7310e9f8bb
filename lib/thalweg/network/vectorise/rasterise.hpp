// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/stream_network.hpp>
#include <thalweg/core/valley.hpp>

namespace thalweg::network {

/// What rasterise() returns.
struct Rasterised {
    Valley valley;
    std::int64_t lowered_cells = 0; ///< cells shared by several reaches that were lowered to keep each path falling
    double max_lowered_m = 0.0;
};

/// Draws the arcs into cells (Bresenham between vertices, height linear along the arc); where several cover a cell the
/// lowest counts, and what lies downstream of it is lowered to it.
/// \pre a network inside the grid; the grid's outer edges belong to its outermost cells.
/// \param network the network
/// \param grid the grid
/// \return heights that never rise along any arc's cells downstream, compared as the floats they are.
/// \throws BadInput naming the arc and the place, when a vertex lies outside the grid or a height is not a number
///
/// Source: \cite cao2009, section 3.3; specification 0.3.
Rasterised rasterise(ElevatedNetwork const& network, Grid const& grid);

} // namespace thalweg::network
