// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/fractal/match_statistics.hpp>

namespace thalweg::fractal {

/// Checks whether any DEM on the grid can have the statistics.
/// \param dem [m] by cell; NaN: no data
/// \param targets statistics to match
/// \throws BadParameter with the numbers, as match_statistics
void check_targets(Raster<float> const& dem, Targets const& targets);

/// Collects the heights to keep.
/// \param dem [m] by cell; NaN: no data
/// \param targets with extremes, if any
/// \param fixed heights of cells
/// \return extremes first, each cell once
/// \throws BadInput as match_statistics
std::vector<FixedHeight> kept_heights(Raster<float> const& dem, Targets const& targets,
                                      std::vector<FixedHeight> const& fixed);

} // namespace thalweg::fractal
