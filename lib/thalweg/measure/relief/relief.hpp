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
#include <thalweg/measure/peaks/orometry.hpp>
#include <thalweg/measure/relief/chi.hpp>
#include <thalweg/measure/relief/geomorphons.hpp>
#include <thalweg/measure/relief/level_patch.hpp>
#include <thalweg/measure/relief/local_extremes.hpp>
#include <thalweg/measure/relief/slope_area.hpp>
#include <thalweg/measure/relief/slope_area_ratio.hpp>
#include <thalweg/measure/relief/slopes.hpp>
#include <thalweg/measure/relief/statistics.hpp>
#include <thalweg/measure/texture/gradient_texture.hpp>
#include <thalweg/measure/texture/straight_channels.hpp>

namespace thalweg::measure {

/// Morphometric indices of a DEM; NaN: the DEM is too small.
struct Relief {
    Slopes slopes;
    std::optional<PowerLaw> slope_area; ///< its exponent is -theta
    std::optional<Chi> chi;
    double hypsometric_integral = 0.5; ///< [0, 1]
    LocalExtremes extremes;
    std::array<double, form_count> forms{};                                ///< [0, 1] shares of geomorphons
    double valleys_over_ridges = std::numeric_limits<double>::quiet_NaN(); ///< cells of valley / ridge
    /// cells of all valley forms / all ridge forms
    double hollows_over_noses = std::numeric_limits<double>::quiet_NaN();
    double length_x = std::numeric_limits<double>::quiet_NaN(); ///< [-] correlation length along rows / width
    double length_y = std::numeric_limits<double>::quiet_NaN(); ///< [-] correlation length along columns / height
    std::int64_t support_cells = 0;                             ///< cells that drain through the first cell of a river
    double drainage_density = std::numeric_limits<double>::quiet_NaN(); ///< [m/m2] of these streams
    /// [-] times the square root of the support's area
    double scaled_density = std::numeric_limits<double>::quiet_NaN();
    double slope_area_ratio = std::numeric_limits<double>::quiet_NaN(); ///< [-] slope of channels / of hillslopes
    GradientTexture texture;
    StraightChannels straight;
    LevelPatch level_patch;
    Orometry orometry;
};

/// Options of relief().
struct ReliefParams {
    GeomorphonParams geomorphons = {};
    SlopeAreaParams slope_area = {};
    ChiParams chi = {};
    std::int64_t support_cells = 200; ///< [1, ...] for the drainage density
    SlopeAreaRatioParams slope_area_ratio = {};
    GradientTextureParams texture = {};
    StraightChannelsParams straight = {};
    LevelPatchParams level_patch = {};
    OrometryParams orometry = {};
};

/// Computes the morphometric indices of a DEM. Valley forms: hollow, footslope, valley, pit; ridge forms: peak, ridge,
/// shoulder, spur.
/// \param dem [m] by cell; NaN: no data
/// \param drainage flow field of the DEM
/// \param statistics of the DEM, by statistics()
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return the same values as the functions for each index; the same bits for any number of threads
/// \throws BadParameter when support_cells is below 1
/// \throws BadInput when the three belong to different DEMs
/// \throws Cancelled
Relief relief(Raster<float> const& dem, flow::FlowField const& drainage, Statistics const& statistics,
              ReliefParams const& params = {}, Run const& run = {});

/// The total variation distance of two distributions of landforms.
/// \param a,b [0, 1] shares by form
/// \return [0, 1] half the sum of absolute differences; 0: equal
double total_variation(std::array<double, form_count> const& a, std::array<double, form_count> const& b);

} // namespace thalweg::measure
