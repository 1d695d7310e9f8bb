// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/ridge_lines.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/measure/drainage/certificate.hpp>

namespace thalweg::measure {

/// The ridges of a DEM compared with prescribed ridges.
struct ExtractedRidges {
    std::int64_t ridge_cells = 0; ///< cells under prescribed ridges with data
    /// contributing area of the inverted DEM at which extraction agrees best within a cell
    std::int64_t threshold_cells = 0;
    Agreements extracted; ///< cells with at least that area, against those under ridges
};

/// Extracts ridges as the streams of the inverted DEM and compares them with prescribed ridges, as certify compares
/// streams.
/// \param dem [m] by cell; NaN: no data
/// \param ridges on the DEM's grid
/// \param run progress, log, stop token and number of threads
/// \return the agreement at the best threshold that certify tries; all 0 without ridges
/// \throws BadInput as flow::route and cells_along
/// \throws Cancelled
///
/// Source: \cite nenu2015, figure 8, whose ridges a GIS extracts so; \cite ocallaghan1984.
ExtractedRidges extract_ridges(Raster<float> const& dem, RidgeLines const& ridges, Run const& run = {});

} // namespace thalweg::measure
