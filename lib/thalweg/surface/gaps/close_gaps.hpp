// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

// Idea: A DEM with holes becomes one without. Gaps that reach the border are the rim, all others
// are enclosed: floods from the border tell them apart. An enclosed gap is taken for water and made
// level at the lowest cell of its shore; the rim is filled, or cut off by the largest rectangle
// that holds no rim cell: row by row, the number of free cells above each column is a histogram,
// and a stack finds its largest rectangle. The sea floods cells at or below its level from the
// border or the rim, so that low land behind dikes stays dry.
// Source: ours.
// Cost: O(cells), also for the largest rectangle; `nearest` adds a distance transform, which runs
// on all cores. The rest on one.
// Not for: interpolation across gaps (surface/diffusion/diffusion.hpp gives smooth heights), or
// rivers and lakes with known levels.
// Example:
//     ClosedGaps const closed = close_gaps(dem, {.rim = RimGaps::nearest, .sea_m = 0.0});
//     Raster<float> const& everywhere = closed.dem; // no NaN
// More: docs/commands.md, "Cells without data".

namespace thalweg::surface {

/// What becomes of cells without data that are connected with the border of a DEM.
enum class RimGaps : std::uint8_t {
    cut,     ///< the DEM is cut to its largest rectangle without them
    nearest, ///< each gets the height of the nearest cell with data
    minimum, ///< all get the lowest height of the DEM
    sea      ///< they lie at the level of the sea
};

/// What becomes of the other cells without data, which land encloses.
enum class EnclosedGaps : std::uint8_t {
    shore,   ///< each gap is level at the lowest cell beside it, as a lake is
    nearest, ///< each cell gets the height of the nearest cell with data
    minimum  ///< all get the lowest height of the DEM
};

/// Options of close_gaps().
struct CloseGapsParams {
    RimGaps rim = RimGaps::cut;
    EnclosedGaps holes = EnclosedGaps::shore;
    std::optional<double> sea_m = {}; ///< [m] level of the sea; nothing: there is none
};

/// A DEM in which every cell has a height.
struct ClosedGaps {
    Raster<float> dem;         ///< [m]
    Cell first;                ///< of the cells kept, in the DEM given
    Mask sea;                  ///< on dem's grid: cells under the sea; without cells: there is no sea
    std::int64_t rim = 0;      ///< cells without data that are connected with the border
    std::int64_t cut = 0;      ///< cells with data that were cut off
    std::int64_t enclosed = 0; ///< other cells without data
    std::int64_t holes = 0;    ///< gaps that these form
    double low_m = 0.0;        ///< lowest height that an enclosed gap got; 0: there is none
    double high_m = 0.0;       ///< the highest
    std::int64_t dry = 0;      ///< cells of the DEM given, at or below the level of the sea, that land encloses
};

/// Gives every cell of a DEM a height. Gaps are 8-connected. The sea covers cells at or below its level that are
/// connected (by sides) with the border of the DEM given or with its rim; other low land stays dry, as polders do.
/// Rivers and lakes are not looked at.
/// \param dem [m] by cell; NaN: no data
/// \return the same for any number of threads; enclosed gaps are closed before the rim
/// \throws BadInput when no cell has a height, when less than 2 x 2 cells remain, or for RimGaps::sea without a level
ClosedGaps close_gaps(Raster<float> const& dem, CloseGapsParams const& params = {}, Run const& run = {});

/// Finds the largest rectangle of cells that are not marked.
/// \param marked at least one cell
/// \return its frame, in the grid given; of several equally large ones the first by its last row, then its last column;
/// width and height are 0 where all cells are marked
Grid largest_rectangle(Mask const& marked, Run const& run = {});

/// Takes the cells of a window.
/// \param raster on a grid
/// \param first north-western cell of the window
/// \param grid of the window: as many cells, inside the raster
/// \return the cells, on that grid
template <class T> Raster<T> window_of(Raster<T> const& raster, Cell first, Grid const& grid) {
    Raster<T> out(grid);
    for (std::int64_t row = 0; row < grid.height; ++row) {
        auto const from = raster.row(first.row + row)
                              .subspan(static_cast<std::size_t>(first.col), static_cast<std::size_t>(grid.width));
        std::copy(from.begin(), from.end(), out.row(row).begin());
    }
    return out;
}

} // namespace thalweg::surface
