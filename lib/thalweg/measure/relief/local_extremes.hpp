// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::measure {

/// What local_extremes() returns.
struct LocalExtremes {
    std::int64_t pits = 0;  ///< cells that all eight neighbours are higher than
    std::int64_t peaks = 0; ///< cells that all eight neighbours are lower than
    std::int64_t cells = 0; ///< that have a height, and eight neighbours with one
};

/// Single cells that stand out of a DEM. Land has fewer pits than peaks, since water fills pits; noise has as many.
/// \param dem [m] heights by cell; NaN: no data
/// \param run progress, log, stop token and number of threads
/// \return the same for any number of threads.
/// \throws Cancelled
LocalExtremes local_extremes(Raster<float> const& dem, Run const& run = {});

} // namespace thalweg::measure
