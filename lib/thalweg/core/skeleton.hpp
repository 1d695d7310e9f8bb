// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>

namespace thalweg {

/// Heights [m] of the cells that constrain a surface (rivers, ridges and points); NaN elsewhere.
struct Skeleton {
    Raster<float> z;
};

} // namespace thalweg
