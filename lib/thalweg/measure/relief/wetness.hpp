// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

// Idea: Soil is wet where much water arrives and little can leave. In a steady state with a
// conductivity that falls exponentially with depth, the depth of the water table is a function of
// ln(a / tan b) alone: a is the area that drains through a metre of width, tan b the slope as the
// hydraulic gradient. Cells with the same index get wet at the same time.
// Source: Beven and Kirkby 1979; slope by Horn 1981.
// Cost: O(n), 8 bytes a cell. Rows run on all cores.
// Not for: areas of D8, which put the water of a hillslope into single lines: take route_dinf's.
// Level land, where the index has no limit: it stops at least_slope. Soils and climates that differ
// within the DEM.
// Example:
//     flow::FlowField const drainage = flow::route(dem);
//     Raster<double> const area = flow::route_dinf(dem, drainage).area_cells;
//     Raster<double> const index = wetness(dem, area, {.least_slope = 0.001});
// More: docs/measures.md.

namespace thalweg::measure {

/// Options of wetness().
struct WetnessParams {
    double least_slope = 0.001; ///< [m/m] > 0, counts for gentler slopes, on which the index has no limit
};

/// Computes the topographic wetness index ln(a / tan b): a is the contributing area per width of a cell [m], tan b the
/// slope by Horn's formula.
/// \param dem [m] by cell; NaN: no data
/// \param area_cells [cells] contributing area, the cell itself included, such as route_dinf's
/// \return [-] by cell; NaN: on the border, beside no data, or no data
/// \throws BadParameter when least_slope is not above 0
/// \throws BadInput when the two differ in grid
///
/// Source: \cite beven1979; \cite horn1981.
Raster<double> wetness(Raster<float> const& dem, Raster<double> const& area_cells, WetnessParams const& params = {},
                       Run const& run = {});

} // namespace thalweg::measure
