// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::measure {

/// The relief of a catchment; NaN: it has no cells, or a single height.
struct ZoneRelief {
    std::int64_t cells = 0;
    double z_min_m = std::numeric_limits<double>::quiet_NaN();
    double z_mean_m = std::numeric_limits<double>::quiet_NaN();
    double z_max_m = std::numeric_limits<double>::quiet_NaN();
    double hypsometric = std::numeric_limits<double>::quiet_NaN();   ///< [0, 1] (mean - min) / (max - min)
    double melton = std::numeric_limits<double>::quiet_NaN();        ///< [-] (max - min) / square root of the area
    double slope_deg = std::numeric_limits<double>::quiet_NaN();     ///< mean by Horn's formula, without edges
    double flow_length_m = std::numeric_limits<double>::quiet_NaN(); ///< longest less shortest length to the outlet
    double form_factor = std::numeric_limits<double>::quiet_NaN();   ///< [-] area / flow_length_m^2
};

/// Measures the relief of catchments.
/// \param dem [m] by cell; NaN: no data, in no catchment
/// \param zone number of the catchment by cell; below 0: none
/// \param zones numbers are below this
/// \param outlet_m [m] by cell: length of the flow path to where water leaves, as lengths_to_outlet
/// \return by number
/// \throws BadInput for a number of zones or more, or another grid
///
/// Source: \cite pike1971; \cite melton1965; \cite horn1981; \cite horton1932 (form factor).
std::vector<ZoneRelief> zone_relief(Raster<float> const& dem, Raster<std::int32_t> const& zone, std::int64_t zones,
                                    Raster<double> const& outlet_m, Run const& run = {});

} // namespace thalweg::measure
