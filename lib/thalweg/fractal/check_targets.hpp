// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/fractal/match_statistics.hpp>

namespace thalweg::fractal {

/// Whether some land can have the statistics at all.
/// \param dem [m] heights by cell; NaN: no data
/// \param targets the target statistics
/// \throws BadParameter with the numbers, as match_statistics
void check_targets(Raster<float> const& dem, Targets const& targets);

/// \param dem [m] heights by cell; NaN: no data
/// \param targets the target statistics
/// \param fixed what keeps its place or height
/// \return the heights to keep, extremes first, each cell once.
/// \throws BadInput as match_statistics
std::vector<FixedHeight> kept_heights(Raster<float> const& dem, Targets const& targets,
                                      std::vector<FixedHeight> const& fixed);

} // namespace thalweg::fractal
