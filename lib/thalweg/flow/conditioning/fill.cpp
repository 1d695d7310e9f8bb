// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/conditioning/internal/fill.hpp>

#include <thalweg/core/cells/framed.hpp>
#include <thalweg/flow/conditioning/internal/flood.hpp>

namespace thalweg::flow {

Raster<float> fill(Raster<float> const& dem, Valley const& valley, Run const& run) {
    check_drainable(dem, valley);
    Raster<float> level = framed(dem);
    flood(level, framed(valley.z), Lakes::slope, run);
    return unframed(level, dem.grid());
}

} // namespace thalweg::flow
