// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::measure {

/// Computes the slope of each cell by Horn's formula.
/// \param dem [m] by cell; NaN: no data
/// \return [deg] in [0, 90) by cell; NaN: on the border, without data, or beside a cell without data
/// \throws BadInput when the cell size is not positive
///
/// Source: \cite horn1981, as gdaldem does.
Raster<float> slope(Raster<float> const& dem, Run const& run = {});

/// Computes the aspect of each cell, the direction in which it falls, by Horn's formula.
/// \param dem [m] by cell; NaN: no data
/// \return [deg] in [0, 360) clockwise from the grid's north, by cell; NaN: level, and where slope() has none
/// \throws BadInput when the cell size is not positive
///
/// Source: \cite horn1981, as gdaldem does.
Raster<float> aspect(Raster<float> const& dem, Run const& run = {});

} // namespace thalweg::measure
