// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::measure {

/// A peak of a DEM: of cells equally high the first in row order is the higher one.
struct Peak {
    std::int64_t cell = 0;
    double height_m = 0.0;
    /// [m] above the highest saddle on a way to higher land; of the highest peak: above the lowest cell of its land
    double prominence_m = 0.0;
};

/// Finds the peaks of a DEM and their prominence: the cells higher than their eight neighbours, all with data, joined
/// over 8-connected saddles from the highest down.
/// \param dem [m] by cell; NaN: no data
/// \param least_m [m] >= 0, peaks of a smaller prominence are left out
/// \param run progress, log, stop token and number of threads
/// \return in row order; the same for any number of threads
/// \throws BadParameter when least_m is outside its range
/// \throws Cancelled
///
/// Source: \cite argudo2019.
std::vector<Peak> prominent_peaks(Raster<float> const& dem, double least_m, Run const& run = {});

} // namespace thalweg::measure
