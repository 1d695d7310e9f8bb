// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::blend {

/// How far it is out of a mask.
/// Gives: [cells] from each centre to the nearest centre of a cell that is not in the mask, 0 for those; infinity where
/// every cell is. Exact up to the square root's rounding, in time that does not depend on the distance.
/// Throws: Cancelled. Source: Felzenszwalb and Huttenlocher 2012, Distance transforms of sampled functions.
Raster<float> distance_within(Mask const& mask, Run const& run = {});

} // namespace thalweg::blend
