// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>

namespace thalweg::blend {

/// A piece of terrain placed on a target's grid.
struct Patch {
    Mask mask;                ///< cells that the patch replaces
    Raster<double> z;         ///< [m] its heights, also outside the mask; NaN: no data
    std::int64_t outside = 0; ///< requested cells that lie off the source
};

} // namespace thalweg::blend
