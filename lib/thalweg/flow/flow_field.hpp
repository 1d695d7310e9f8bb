// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/flow/direction.hpp>

namespace thalweg::flow {

/// Cells, side by side or by their corners, that lie below the level at which their water spills.
struct Depression {
    Cell lowest; ///< ties: the first in row order
    std::int64_t cells = 0;
    double max_depth_m = 0.0;
    double volume_m3 = 0.0; ///< of the water that would fill it
};

/// Where the water of each cell goes (D8). Law: directions stay on the grid, lead to no cell without data, and close no
/// circle; route makes it so.
struct FlowField {
    Raster<Direction> direction;
    Raster<std::int64_t> area_cells;          ///< cells that drain through a cell, itself included; 0 without data
    std::int64_t pits = 0;                    ///< cells in depressions (below the level at which they spill)
    double pit_volume_m3 = 0.0;               ///< of the water that would fill them
    std::vector<Depression> depressions = {}; ///< by their first cell

    Grid const& grid() const { return direction.grid(); }
    /// \param cell index of the cell
    /// \return the cell to which the water of a cell goes, -1 where it goes to none.
    std::int64_t receiver(std::int64_t cell) const { return flow::receiver(direction, cell); }
};

} // namespace thalweg::flow
