// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>

namespace thalweg {

/// Heights [m] of all cells that a surface is drawn through, rivers, ridges and points; NaN elsewhere.
struct Skeleton {
    Raster<float> z;
};

} // namespace thalweg
