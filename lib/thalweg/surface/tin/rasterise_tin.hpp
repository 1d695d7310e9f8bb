// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/tin.hpp>

namespace thalweg::surface {

/// Options of rasterise_tin().
struct RasteriseTinParams {
    /// Cells whose centre no triangle holds: NaN, or the height at the nearest point of the TIN's edge.
    enum class Outside : std::uint8_t { no_data, nearest };
    Outside outside = Outside::no_data;
};

/// Linear heights of a TIN at the centres of cells.
/// \pre a TIN, one without triangles included; a grid.
/// \param tin the TIN
/// \param grid the grid
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return in each cell whose centre lies in the TIN, its edge included, the height there of the triangle that owns it,
/// computed in double and never beyond the triangle's corners. A centre on an edge shared by triangles belongs to that
/// on its east (of a level edge: on its north): decided exactly, so that no cell is left out and none is drawn twice.
/// \throws BadInput naming vertex or triangle when one is not finite, not counterclockwise or not there
/// \throws Cancelled
///
/// Source: scanlines with exact orientation tests where rounding could decide.
Raster<float> rasterise_tin(Tin const& tin, Grid const& grid, RasteriseTinParams const& params = {},
                            Run const& run = {});

} // namespace thalweg::surface
