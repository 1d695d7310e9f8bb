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
    std::int64_t support_cells = 200; ///< [1, ...] cells that drain through a cell in which a river runs
    int bins_per_decade = 5;          ///< [1, 100] of area
    std::int64_t least_places = 20;   ///< [1, ...] a bin of fewer cells is left out
    std::int64_t least_bins = 3;      ///< [3, ...] below there is no law
};

/// Flint's law S = k A^-theta of the rivers that a DEM's water draws: the exponent is -theta.
/// \pre a DEM and its drainage.
/// \param dem [m] heights by cell; NaN: no data
/// \param drainage the flow field of the DEM
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return in bins of area, the whole drop of all river cells to where their water goes over the whole way: a bin is
/// one long reach, in which level steps, and those that rise out of a pit, count as what they are (no logarithm is
/// taken of one step, so whole metres and noise do not lift the mean); its area is the geometric mean. The line of
/// least squares through the bins' logarithms, a bin counting by the root of its cells: those of large areas are few,
/// along one river; bins that do not fall are left out. Steps out of the DEM are none.
/// \throws BadParameter
/// \throws BadInput when DEM and drainage have not one grid
/// \throws Cancelled
///
/// Source: \cite flint1974; \cite wobus2006 (slope over elevation drops, log bins).
std::optional<PowerLaw> slope_area(Raster<float> const& dem, flow::FlowField const& drainage,
                                   SlopeAreaParams const& params = {}, Run const& run = {});

} // namespace thalweg::measure
