// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/measure/laws/fits.hpp>

// Idea: Where uplift and erosion balance, slope falls with a power of area, S = k A^-theta. Slopes
// of single cells are a poor measure of it: heights in whole metres give zeros and jumps, and zeros
// have no logarithm. So the cells of a bin of area count as one long reach, whose slope is total
// drop over total length; errors of single heights then cancel along a flow path. chi avoids slopes
// altogether: the law, integrated from the outlet up, makes height a linear function of chi, the
// integral of (1 m2 / A)^theta, so that r2 of height against chi tells how near a river is to
// equilibrium.
// Source: Flint 1974; Wobus et al. 2006; Perron and Royden 2013.
// Cost: O(n log bins) for slope_area; one pass and the cells of the stems for chi. One thread.
// Not for: hillslopes and channels in one fit: choose support_cells so that only channels count.
// DEMs cut by their border, whose areas are too small; rivers of a file
// (measure/rivers/profiles.hpp has them, carved).
// Example:
//     auto const law = slope_area(dem, flow_field, {.support_cells = 200});
//     double const theta = law ? -law->exponent : 0.45;
//     auto const straight = chi(dem, flow_field, {.theta = theta});
// More: docs/relief_measures.md, "Methods".

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
/// \return the exponent is -theta; nothing with fewer than least_bins bins
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput when DEM and flow field differ in grid
///
/// Source: \cite flint1974; \cite wobus2006 (slope over elevation drops, log bins).
std::optional<PowerLaw> slope_area(Raster<float> const& dem, flow::FlowField const& drainage,
                                   SlopeAreaParams const& params = {}, Run const& run = {});

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
/// \return over the stems of the largest basins: from the outlet up along the largest area (ties: lowest direction) to
/// the support. Nothing if no stem has least_cells cells and falls.
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput when DEM and flow field differ in grid
///
/// Source: \cite perron2013.
std::optional<Chi> chi(Raster<float> const& dem, flow::FlowField const& drainage, ChiParams const& params = {},
                       Run const& run = {});

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
/// \return [-] NaN where the DEM has no cells of either, or no slope
/// \throws BadParameter when an area is below 1, or a range is empty
/// \throws BadInput when DEM and flow field differ in grid
///
/// Source: \cite horn1981.
double slope_area_ratio(Raster<float> const& dem, flow::FlowField const& drainage,
                        SlopeAreaRatioParams const& params = {}, Run const& run = {});

} // namespace thalweg::measure
