// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/flow_field.hpp>

namespace thalweg::measure {

/// Options of slope_area_ratio(): contributing areas [cells], each >= 1, from the first to below the second.
struct SlopeAreaRatioParams {
    std::int64_t hillslope_from = 3;
    std::int64_t hillslope_to = 10;
    std::int64_t channel_from = 3000;
    std::int64_t channel_to = 10000;
};

/// Computes the slope of channels over that of hillslopes: mean tangents by Horn's formula, without borders and cells
/// beside holes.
/// \param dem [m] by cell; NaN: no data
/// \param drainage flow field of the DEM
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return [-] NaN where the DEM has no cells of either, or no slope
/// \throws BadParameter when an area is below 1, or a range is empty
/// \throws BadInput when DEM and flow field differ in grid
/// \throws Cancelled
///
/// Source: \cite horn1981.
double slope_area_ratio(Raster<float> const& dem, flow::FlowField const& drainage,
                        SlopeAreaRatioParams const& params = {}, Run const& run = {});

} // namespace thalweg::measure
