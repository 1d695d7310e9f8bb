// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::measure {

/// How the peaks of a DEM stand to one another; NaN: it has none.
struct Orometry {
    std::int64_t peaks = 0;                                                ///< of least_prominence_m or more
    double peaks_per_km2 = std::numeric_limits<double>::quiet_NaN();       ///< of cells with data
    double median_prominence_m = std::numeric_limits<double>::quiet_NaN(); ///< [m]
    double median_isolation_m = std::numeric_limits<double>::quiet_NaN();  ///< [m] without the highest peak
};

/// Options of orometry().
struct OrometryParams {
    double least_prominence_m = 30.0; ///< [m] >= 0
};

/// Measures the peaks of a DEM.
/// \param dem [m] by cell; NaN: no data
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return the same for any number of threads
/// \throws BadParameter when least_prominence_m is outside its range
/// \throws Cancelled
///
/// Source: \cite argudo2019.
Orometry orometry(Raster<float> const& dem, OrometryParams const& params = {}, Run const& run = {});

} // namespace thalweg::measure
