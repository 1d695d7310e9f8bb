// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/route.hpp>

// Idea: Computed land tends to be equally steep everywhere, to have no gentle places but along its
// rivers, and to meet what it was given with an edge: one-cell trenches at the heads of rivers, walls
// along the divide of a river file. A mean over the whole DEM shows none of that. So slopes are
// averaged in windows of a few kilometres, whose spread tells how much land differs from place to
// place; gentle land is counted away from rivers; profiles are compared half-way up; the lower bank
// of each river cell tells trenches. The drop over a kilometre tells walls: on real land the greatest
// is half as great again as the 90th percentile, whatever the land.
// Source: ours: docs/relief_measures.md. Natural values: ten reference DEMs.
// Cost: O(n). Rows run on all cores; a byte a cell.
// Not for: DEMs smaller than four windows, whose spread is NaN. Rivers wider than a cell: only their
// outer cells have banks.
// Example:
//     Variety const found = variety(dem, drainage, river_cells, {.window_m = 3000.0});
//     bool const alike = found.slope_spread_deg < 3.0;
//     bool const has_walls = found.wall > 1.5;
// More: docs/relief_measures.md, "Methods".

namespace thalweg::measure {

/// How much the land differs from place to place, and how it meets its rivers; NaN: unknown.
struct Variety {
    std::int64_t windows = 0; ///< at least half full of slopes
    /// [degrees] standard deviation of the windows' mean slopes; NaN with fewer than four windows
    double slope_spread_deg = std::numeric_limits<double>::quiet_NaN();
    double gentle_share = std::numeric_limits<double>::quiet_NaN();      ///< [0, 1] of the slopes
    double gentle_away_share = std::numeric_limits<double>::quiet_NaN(); ///< [0, 1] gentle and away from rivers
    std::int64_t stems = 0;                                              ///< main stems measured
    /// (height half-way - mouth) / (source - mouth) of main stems, median
    double half_way_height = std::numeric_limits<double>::quiet_NaN();
    std::int64_t river_cells = 0; ///< given, or of the DEM's streams
    std::int64_t canal_cells = 0; ///< of these with steep banks all round
    double outside_share = 0.0;   ///< [0, 1] of the land drains past the given rivers
    /// [-] drop over wall_m, 99.9th over 90th percentile: 1.5 to 2 on real land; NaN where the DEM is narrower than two
    double steepest_drop = std::numeric_limits<double>::quiet_NaN();
    /// [-] the drop along the divide of the given rivers' land over that more than divide_m away, 99th percentiles; NaN
    /// without given rivers, or with too little land on either side or away from the divide
    double wall = std::numeric_limits<double>::quiet_NaN();

    /// [0, 1] of the river cells; NaN without any
    double canal_share() const {
        return river_cells > 0 ? static_cast<double>(canal_cells) / static_cast<double>(river_cells)
                               : std::numeric_limits<double>::quiet_NaN();
    }
};

/// Options of variety().
struct VarietyParams {
    double window_m = 3000.0;     ///< [m] > 0 side of the square windows of mean slope
    double gentle_deg = 4.0;      ///< [degrees] (0, 90) below which land is gentle
    double away_m = 240.0;        ///< [m] >= 0 from the nearest river cell
    double stream_m2 = 1e6;       ///< [m2] > 0 contributing area at which streams and stems begin
    std::int64_t stem_cells = 50; ///< [3, ...] minimum length of a stem
    std::int64_t most_stems = 20; ///< [1, ...] of the largest basins
    double bank_tangent = 1.0;    ///< [m/m] > 0 rise of a canal's lower bank over the cell size
    double wall_m = 1000.0;       ///< [m] > 0 over which drops are measured
    double divide_m = 3000.0;     ///< [m] >= 0 from the divide to where land is elsewhere
    double least_share = 0.05;    ///< [0, 1] of the land past the rivers, to them, and elsewhere
};

/// Measures how much land differs from place to place, and how it meets its rivers. Slopes are Horn's, without borders
/// and cells beside no data. A stem goes from where water leaves the DEM up along the largest area to stream_m2. A
/// canal cell is a river cell whose lowest neighbour that is no river cell stands more than bank_tangent times the cell
/// size above it. The drop at a cell is that to the lowest of 16 places wall_m away, measured on cells a tenth of it
/// apart and on the divide: the cells of which some neighbour drains to a given river and some past all.
/// \param dem [m] by cell; NaN: no data
/// \param drainage flow field of the DEM
/// \param rivers indices of given river cells; empty: none are given, and cells that stream_m2 drain through count
/// \return the same bits for any number of threads
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput when DEM and flow field differ in grid, the cell size is not positive, or a river cell is outside
/// the DEM
///
/// Source: \cite horn1981.
Variety variety(Raster<float> const& dem, flow::FlowField const& drainage, std::span<std::int64_t const> rivers,
                VarietyParams const& params = {}, Run const& run = {});

/// The same without given rivers: cells that stream_m2 drain through count.
/// \param dem [m] by cell; NaN: no data
/// \param drainage flow field of the DEM
/// \throws BadParameter, BadInput as with rivers
Variety variety(Raster<float> const& dem, flow::FlowField const& drainage, VarietyParams const& params = {},
                Run const& run = {});

} // namespace thalweg::measure
