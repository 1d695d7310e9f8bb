// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

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
