// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include <thalweg/core/raster.hpp>

namespace thalweg::make {

/// A valley as its cells alone: rivers run in a few of a hundred cells, and a raster of them is as large as the DEM.
struct ValleyCells {
    Grid grid = {};
    std::vector<CellIndex> cell = {}; ///< places in the grid, row by row, ascending
    std::vector<float> z = {};        ///< [m] of each

    /// \return [m] by cell of the grid; NaN: no river
    Raster<float> raster() const;
};

/// \internal
/// The cells of a valley that have heights.
ValleyCells valley_cells(Valley const& valley);

/// \internal
/// Cells with their heights in any order. Of a cell named twice the last height counts; one that is
/// NaN leaves it out.
ValleyCells valley_cells(Grid const& grid, std::vector<std::pair<CellIndex, float>> heights);

/// \internal
/// Whether a river runs in a cell.
bool has_river(ValleyCells const& valley, CellIndex cell);

/// \internal
/// [m] The height of a river in a cell; NaN: there is none.
float height_in(ValleyCells const& valley, CellIndex cell);

} // namespace thalweg::make
