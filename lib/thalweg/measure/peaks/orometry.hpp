// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::measure {

/// A peak of a DEM: of cells equally high the first in row order is the higher one.
struct Peak {
    std::int64_t cell = 0;
    double height_m = 0.0;
    /// [m] above the highest saddle on a path to higher terrain; of the highest peak: above the lowest cell connected
    /// to it
    double prominence_m = 0.0;
};

/// Finds the peaks of a DEM and their prominence: the cells higher than their eight neighbours, all with data, joined
/// over 8-connected saddles from the highest down.
/// \param dem [m] by cell; NaN: no data
/// \param least_m [m] >= 0, peaks of a smaller prominence are left out
/// \return in row order; the same for any number of threads
/// \throws BadParameter when least_m is outside its range
///
/// Source: \cite argudo2019.
std::vector<Peak> prominent_peaks(Raster<float> const& dem, double least_m, Run const& run = {});

/// Finds the distance to the nearest higher cell.
/// \param dem [m] by cell; NaN: no data
/// \param cell index of a peak's cell
/// \return [m] from centre to centre; NaN: no cell is higher
/// \throws BadInput when the DEM has no such cell
///
/// Source: \cite argudo2019.
double isolation(Raster<float> const& dem, std::int64_t cell);

/// Metrics of a DEM's peaks; NaN: it has none.
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
/// \return the same for any number of threads
/// \throws BadParameter when least_prominence_m is outside its range
///
/// Source: \cite argudo2019.
Orometry orometry(Raster<float> const& dem, OrometryParams const& params = {}, Run const& run = {});

} // namespace thalweg::measure
