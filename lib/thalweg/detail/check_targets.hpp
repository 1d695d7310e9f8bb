// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/detail/project.hpp>

namespace thalweg::detail {

/// Whether some land can have the statistics at all. Throws: BadParameter with the numbers, as project.
void check_targets(Raster<float> const& dem, Targets const& targets);

/// The heights to keep, extremes first, each cell once.
/// Throws: BadInput as project.
std::vector<FixedHeight> kept_heights(Raster<float> const& dem, Targets const& targets,
                                      std::vector<FixedHeight> const& fixed);

} // namespace thalweg::detail
