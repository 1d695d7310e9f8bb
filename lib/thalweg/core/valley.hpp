// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>

namespace thalweg {

/// Heights [m] of the river cells, NaN elsewhere: the constraint of a surface.
struct Valley {
    Raster<float> z;
};

} // namespace thalweg
