// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::detail {

/// The coarse forms of a land with the fine ones of another: its means over a Gaussian window of `cells` [cells]
/// deviation, and what the other departs from such means.
/// Takes: two lands on one grid; cells > 0. What lies beyond the border is mirrored.
/// Gives: of two equal lands the same land, to rounding. The same bits for any number of threads.
/// Throws: BadParameter when cells is not in (0, 1000]; BadInput when the grids differ or a height is not finite;
/// Cancelled.
Raster<float> with_fine_forms(Raster<float> const& land, Raster<float> const& fine, double cells, Run const& run = {});

} // namespace thalweg::detail
