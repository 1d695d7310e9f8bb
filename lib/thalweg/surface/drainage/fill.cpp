// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/drainage/internal/fill.hpp>

#include <thalweg/surface/drainage/internal/flood.hpp>

namespace thalweg::surface {

Raster<float> fill(Raster<float> const& dem, Valley const& valley, Run const& run) {
    check_drainable(dem, valley);
    Raster<float> level = framed(dem);
    flood(level, framed(valley.z), Lakes::slope, run);
    return unframed(level, dem.grid());
}

} // namespace thalweg::surface
