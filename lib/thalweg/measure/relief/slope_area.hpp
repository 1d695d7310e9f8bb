// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/flow_field.hpp>
#include <thalweg/measure/laws/power_law.hpp>

namespace thalweg::measure {

/// Options of slope_area().
struct SlopeAreaParams {
    std::int64_t support_cells = 200; ///< [1, ...] contributing area at which streams begin
    int bins_per_decade = 5;          ///< [1, 100] of area
    std::int64_t least_places = 20;   ///< [1, ...] minimum number of cells in a bin
    std::int64_t least_bins = 3;      ///< [3, ...] minimum number of bins for a law
};

/// Fits Flint's law S = k A^-theta to the streams of a DEM. A bin of area is treated as one long reach: total drop of
/// its cells to their receivers over total length, so that level steps and noise do not bias the mean; its area is the
/// geometric mean. Least squares of the bins' logarithms, weighted by the square root of their cells; bins that do not
/// fall, and steps off the DEM, are left out.
/// \param dem [m] by cell; NaN: no data
/// \param drainage flow field of the DEM
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return the exponent is -theta; nothing with fewer than least_bins bins
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput when DEM and flow field differ in grid
/// \throws Cancelled
///
/// Source: \cite flint1974; \cite wobus2006 (slope over elevation drops, log bins).
std::optional<PowerLaw> slope_area(Raster<float> const& dem, flow::FlowField const& drainage,
                                   SlopeAreaParams const& params = {}, Run const& run = {});

} // namespace thalweg::measure
