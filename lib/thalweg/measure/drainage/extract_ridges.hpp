// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/ridge_lines.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/measure/drainage/certificate.hpp>

namespace thalweg::measure {

/// The ridges that a DEM has by itself, beside those that were asked for.
struct ExtractedRidges {
    std::int64_t ridge_cells = 0;     ///< cells under the ridges asked for, where the DEM has heights
    std::int64_t threshold_cells = 0; ///< of area of the DEM upside down, at which extraction agrees best within a cell
    Agreements extracted;             ///< the cells with that area or more, against those under the ridges
};

/// Extracts ridges as the streams of the DEM upside down, and compares them with given ones as certify compares
/// streams.
/// \pre a DEM; ridges on its grid.
/// \param dem [m] heights by cell; NaN: no data
/// \param ridges the ridge lines
/// \param run progress, log, stop token and number of threads
/// \return the agreement at the best of the thresholds that certify tries; all 0 without ridges.
/// \throws BadInput as flow::route and cells_along do
/// \throws Cancelled
///
/// Source: \cite nenu2015, figure 8, whose ridges are extracted so by a GIS; \cite ocallaghan1984.
ExtractedRidges extract_ridges(Raster<float> const& dem, RidgeLines const& ridges, Run const& run = {});

} // namespace thalweg::measure
