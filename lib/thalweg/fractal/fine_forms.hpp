// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::fractal {

/// The coarse forms of a land with the fine ones of another: its means over a Gaussian window of `cells` [cells]
/// deviation, and what the other departs from such means.
/// \pre two lands on one grid; cells > 0. What lies beyond the border is mirrored.
/// \param land [m] the DEM with the coarse forms
/// \param fine [m] the DEM with the fine forms
/// \param cells [cells] (0, 1000] deviation of the window
/// \param run progress, log, stop token and number of threads
/// \return of two equal lands the same land, to rounding. The same bits for any number of threads.
/// \throws BadParameter when cells is not in (0, 1000]
/// \throws BadInput when the grids differ or a height is not finite
/// \throws Cancelled
Raster<float> with_fine_forms(Raster<float> const& land, Raster<float> const& fine, double cells, Run const& run = {});

} // namespace thalweg::fractal
