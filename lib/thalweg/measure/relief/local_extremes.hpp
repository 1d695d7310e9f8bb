// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::measure {

/// What local_extremes() returns.
struct LocalExtremes {
    std::int64_t pits = 0;  ///< cells lower than all eight neighbours
    std::int64_t peaks = 0; ///< cells higher than all eight neighbours
    std::int64_t cells = 0; ///< with data and eight neighbours with data
};

/// Counts single-cell pits and peaks. Fluvial terrain has fewer pits than peaks, because water fills pits; noise has as
/// many of each.
/// \param dem [m] by cell; NaN: no data
/// \param run progress, log, stop token and number of threads
/// \return the same for any number of threads
/// \throws Cancelled
LocalExtremes local_extremes(Raster<float> const& dem, Run const& run = {});

} // namespace thalweg::measure
