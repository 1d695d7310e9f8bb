// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

// Idea: Prominence asks how far one must descend from a peak before one can climb to a higher one.
// From every cell the steps to the highest neighbour lead to one peak, so that the peaks divide the
// DEM into areas. Where two areas touch, only their highest saddle matters. Saddles are taken from
// the highest down, as if a sea receded: each joins the areas on its two sides, and the lower of
// their highest peaks gets its height above that saddle (union-find). Isolation is the distance to
// the nearest higher cell, found in rings around the peak that stop as soon as no ring can hold a
// nearer one.
// Source: Argudo et al. 2019, for the metrics.
// Cost: O(n + s log s) for s pairs of areas that touch; isolation O(r^2) for a distance of r cells,
// O(n) for a peak that nothing exceeds. Memory about one byte a cell and the saddles. Areas and
// isolation run on all cores.
// Not for: the prominence of peaks whose higher neighbour lies off the DEM: it is too large, and
// peaks on the border are left out. White noise has a peak in every ninth cell: set
// least_prominence_m.
// Example:
//     std::vector<Peak> const peaks = prominent_peaks(dem, 30.0);
//     Orometry const metrics = orometry(dem, {.least_prominence_m = 50.0});
//     double const far_m = peaks.empty() ? 0.0 : isolation(dem, peaks.front().cell);
// More: docs/relief_measures.md, "Methods".

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
