// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/flow_field.hpp>
#include <thalweg/measure/relief/chi.hpp>
#include <thalweg/measure/relief/geomorphons.hpp>
#include <thalweg/measure/relief/local_extremes.hpp>
#include <thalweg/measure/relief/slope_area.hpp>
#include <thalweg/measure/relief/slopes.hpp>
#include <thalweg/measure/relief/statistics.hpp>

namespace thalweg::measure {

/// Morphometric indices of a DEM. NaN where the land is too small to tell.
struct Relief {
    Slopes slopes;
    std::optional<PowerLaw> slope_area; ///< exponent -theta
    std::optional<Chi> chi;
    double hypsometric_integral = 0.5; ///< [0,1]
    LocalExtremes extremes;
    std::array<double, form_count> forms{};                                ///< [0,1] shares of the geomorphons
    double valleys_over_ridges = std::numeric_limits<double>::quiet_NaN(); ///< cells of the forms valley and ridge
    double hollows_over_noses = std::numeric_limits<double>::quiet_NaN();  ///< all forms of valleys over all of ridges
    double length_x = std::numeric_limits<double>::quiet_NaN(); ///< [-] correlation length along rows, over the width
    double length_y = std::numeric_limits<double>::quiet_NaN(); ///< [-] along columns, over the height
    std::int64_t support_cells = 0;                             ///< cells that drain through the first cell of a river
    double drainage_density = std::numeric_limits<double>::quiet_NaN(); ///< [m/m2] of those rivers
    double scaled_density = std::numeric_limits<double>::quiet_NaN();   ///< [-] times the root of the support's area
};

/// Options of relief().
struct ReliefParams {
    GeomorphonParams geomorphons = {};
    SlopeAreaParams slope_area = {};
    ChiParams chi = {};
    std::int64_t support_cells = 200; ///< [1, ...] for the drainage density
};

/// \pre a DEM with its drainage and statistics.
/// \param dem [m] heights by cell; NaN: no data
/// \param drainage the flow field of the DEM
/// \param statistics its statistics
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return all the same figures that the parts give; hollows: hollow, footslope, valley and pit; noses: peak, ridge,
/// shoulder and spur. The same bits for any number of threads.
/// \throws BadParameter
/// \throws BadInput when the three are not of one DEM
/// \throws Cancelled
Relief relief(Raster<float> const& dem, flow::FlowField const& drainage, Statistics const& statistics,
              ReliefParams const& params = {}, Run const& run = {});

/// \param a shares by form
/// \param b shares by form
/// \return half the sum of the differences of shares: 0 where they are alike, 1 where they have nothing in common.
double total_variation(std::array<double, form_count> const& a, std::array<double, form_count> const& b);

} // namespace thalweg::measure
