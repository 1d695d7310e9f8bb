// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::fractal {

/// Combines the coarse forms of one DEM with the fine forms of another: the first's means over a Gaussian window, plus
/// the second's differences from such means. The border mirrors what lies beyond.
/// \param land [m] by cell: the DEM with the coarse forms
/// \param fine [m] by cell, on the same grid: the DEM with the fine forms
/// \param cells [cells] (0, 1000] standard deviation of the window
/// \param run progress, log, stop token and number of threads
/// \return for two equal DEMs the same DEM, to rounding; the same bits for any number of threads
/// \throws BadParameter when cells is outside its range
/// \throws BadInput when the grids differ or a height is not finite
/// \throws Cancelled
Raster<float> with_fine_forms(Raster<float> const& land, Raster<float> const& fine, double cells, Run const& run = {});

} // namespace thalweg::fractal
