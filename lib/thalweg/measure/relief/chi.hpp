// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/flow_field.hpp>

namespace thalweg::measure {

/// Options of chi().
struct ChiParams {
    double theta = 0.45;              ///< [0, 2] concavity index
    std::int64_t support_cells = 200; ///< [1, ...] contributing area at which streams begin
    std::int64_t least_cells = 50;    ///< [3, ...] minimum length of a stem
    std::int64_t most_stems = 20;     ///< [1, ...] of the largest basins
};

/// How straight longitudinal profiles are in chi.
struct Chi {
    double theta = 0.0;          ///< as it was taken
    double r2 = 0.0;             ///< of height against chi, over all stems, each with its own line
    double main_r2 = 0.0;        ///< of the largest basin's stem
    double main_steepness = 0.0; ///< [m^(2 theta)] its slope, with chi for an area of 1 m2
    std::int64_t stems = 0;
    std::int64_t cells = 0; ///< of all stems
};

/// Fits heights along main stems against chi, the integral of (1 m2 / A)^theta along the river from its outlet. A river
/// in equilibrium with uniform uplift is a straight line: r2 = 1.
/// \param dem [m] by cell; NaN: no data
/// \param drainage flow field of the DEM
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return over the stems of the largest basins: from the outlet up along the largest area (ties: lowest direction) to
/// the support. Nothing if no stem has least_cells cells and falls.
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput when DEM and flow field differ in grid
/// \throws Cancelled
///
/// Source: \cite perron2013.
std::optional<Chi> chi(Raster<float> const& dem, flow::FlowField const& drainage, ChiParams const& params = {},
                       Run const& run = {});

} // namespace thalweg::measure
