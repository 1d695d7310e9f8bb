// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::measure {

/// Options of level_patch().
struct LevelPatchParams {
    double below_deg = 3.0; ///< [degrees] (0, 90) slope by Horn's formula
};

/// The largest 8-connected patch of gentle slopes.
struct LevelPatch {
    std::int64_t cells = 0; ///< of the patch
    std::int64_t land = 0;  ///< with data and eight neighbours with data, lakes left out
};

/// Finds the largest 8-connected patch of cells with a slope below below_deg. A cell as high as all its neighbours
/// is a lake's surface and counts nowhere.
/// \param dem [m] by cell; NaN: no data
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return cells; the same for any number of threads
/// \throws BadParameter when below_deg is outside its range
/// \throws BadInput when the cell size is not positive
/// \throws Cancelled
LevelPatch level_patch(Raster<float> const& dem, LevelPatchParams const& params = {}, Run const& run = {});

} // namespace thalweg::measure
