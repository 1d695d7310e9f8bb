// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>

namespace thalweg::blend {

/// A piece of land laid on a target: both rasters on the target's grid.
struct Patch {
    Mask mask;                ///< cells that the patch replaces
    Raster<double> z;         ///< [m] its heights, beside the mask too; NaN where it has none
    std::int64_t outside = 0; ///< cells that were asked for and lie off the source
};

} // namespace thalweg::blend
