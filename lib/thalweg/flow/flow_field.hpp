// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/flow/direction.hpp>

namespace thalweg::flow {

/// A depression: 8-connected cells below their spill level.
struct Depression {
    Cell lowest; ///< of several the first in row order
    std::int64_t cells = 0;
    double max_depth_m = 0.0;
    double volume_m3 = 0.0; ///< to its spill level
};

/// D8 flow directions and contributing areas of a DEM. Law: directions stay on the grid, do not lead to cells without
/// data and form no cycle.
struct FlowField {
    Raster<Direction> direction;
    Raster<std::int64_t> area_cells;          ///< cells that drain through a cell, itself included; 0: no data
    std::int64_t pits = 0;                    ///< cells in depressions (below their spill level)
    double pit_volume_m3 = 0.0;               ///< of all depressions
    std::vector<Depression> depressions = {}; ///< in the order of their first cells

    Grid const& grid() const { return direction.grid(); }
    /// Finds the D8 receiver of a cell.
    /// \param cell index of the cell
    /// \return index of the neighbour; -1: none
    std::int64_t receiver(std::int64_t cell) const { return flow::receiver(direction, cell); }
};

} // namespace thalweg::flow
