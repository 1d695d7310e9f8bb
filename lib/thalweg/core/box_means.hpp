// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg {

/// \internal
/// The frame of a raster averaged to fewer columns.
/// \param grid at least one cell
/// \param columns [1, grid.width]
/// \return square cells, from the same corner and equally wide; the last row may reach beyond the grid
Grid coarser(Grid const& grid, std::int64_t columns);

/// \internal
/// Averages a raster over the cells of a coarser grid, by area, in one pass: what a picture shows of it.
/// \param fine at least one cell; one without a value (NaN) has no weight
/// \param columns [1, width of the raster]
/// \return on coarser(): NaN where less than half of a cell has values
Raster<float> box_means(Raster<float> const& fine, std::int64_t columns, Run const& run = {});

/// \internal
/// \param fine at least one cell
/// \param columns [1, width of the mask]
/// \return on coarser(): whether at least half of a cell is marked
Mask box_means(Mask const& fine, std::int64_t columns, Run const& run = {});

/// \internal
/// \param fine at least one cell
/// \param columns [1, width of the mask]
/// \return on coarser(): whether the centre of a marked cell is in a cell, which keeps thin lines
Mask box_marks(Mask const& fine, std::int64_t columns);

/// \internal
/// \param fine at least one cell
/// \param side [cells] >= 1 of a block
/// \return by block the highest value, NaN where it has none; the last column and row of blocks may be narrower
Raster<float> block_maxima(Raster<float> const& fine, std::int64_t side, Run const& run = {});

/// \internal
/// What pictures show of a raster.
struct Overview {
    std::optional<std::pair<double, double>> range; ///< lowest and highest value that is finite; nothing: there is none
    Raster<float> means;  ///< as box_means(); without cells where the raster has no more columns than are wanted
    Raster<float> maxima; ///< as block_maxima(); without cells for blocks of a single cell
};

/// \internal
/// Finds an overview in one pass.
/// \param fine a value that is no number (NaN) is none; may have no cells
/// \param columns >= 1 of the means
/// \param side [cells] >= 1 of the blocks
/// \return the same for any number of threads
Overview overview(Raster<float> const& fine, std::int64_t columns, std::int64_t side, Run const& run = {});

} // namespace thalweg
