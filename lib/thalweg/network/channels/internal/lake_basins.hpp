// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/raster.hpp>

/// A step of flood_lakes. Private to this module.
namespace thalweg::network {

/// Calls visit(index) for the neighbours of a cell, by side or corner.
template <class Visit> void each_neighbour(Grid const& grid, std::int64_t cell, Visit visit) {
    Cell const c = grid.at(cell);
    for (Cell const step : d8_steps) {
        if (Cell const n{c.col + step.col, c.row + step.row}; grid.contains(n)) {
            visit(grid.index(n));
        }
    }
}

/// A lake before it is flooded.
struct Basin {
    std::int32_t label = 0;
    std::int64_t cut = 0; ///< cells that its label lost
    std::vector<std::int64_t> cells;
};

/// Labels without cells on the grid's edge, or beside a lesser label. Throws: BadInput for a label below 0.
Raster<std::int32_t> kept_apart(Raster<std::int32_t> const& labels);

/// The lakes of a raster of labels of which some cells are kept, in the order of their first cells.
std::vector<Basin> basins_of(Raster<std::int32_t> const& labels, Raster<std::int32_t> left);

} // namespace thalweg::network
