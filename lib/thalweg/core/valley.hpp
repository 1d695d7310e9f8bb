// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>

namespace thalweg {

/// Heights [m] of the cells in which rivers run, NaN elsewhere: what a surface is drawn through.
struct Valley {
    Raster<float> z;
};

} // namespace thalweg
