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
    double theta = 0.45;              ///< [0, 2] concavity
    std::int64_t support_cells = 200; ///< [1, ...] cells that drain through the first cell of a river
    std::int64_t least_cells = 50;    ///< [3, ...] of a stem
    std::int64_t most_stems = 20;     ///< [1, ...] of the largest basins
};

/// How straight rivers are where the way along them is counted in chi.
struct Chi {
    double theta = 0.0;          ///< as it was taken
    double r2 = 0.0;             ///< of height against chi: of all stems, each with a line of its own
    double main_r2 = 0.0;        ///< of the stem of the largest basin
    double main_steepness = 0.0; ///< [m^(2 theta)] of it: slope of its line, chi for an area of 1 m2
    std::int64_t stems = 0;
    std::int64_t cells = 0; ///< of all stems
};

/// Heights along main stems against chi, the integral of (1 m2 / A)^theta along the river from its outlet.
/// \pre a DEM and its drainage.
/// \param dem [m] heights by cell; NaN: no data
/// \param drainage the flow field of the DEM
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return stems of the largest basins, from where water leaves the DEM up along the greatest area (ties: lowest
/// direction) to the support; none shorter than least_cells. A river in equilibrium with even uplift is a straight
/// line: r2 = 1. None where no stem is long enough or falls.
/// \throws BadParameter
/// \throws BadInput when DEM and drainage have not one grid
/// \throws Cancelled
///
/// Source: \cite perron2013.
std::optional<Chi> chi(Raster<float> const& dem, flow::FlowField const& drainage, ChiParams const& params = {},
                       Run const& run = {});

} // namespace thalweg::measure
