// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <thalweg/core/channels.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/direction.hpp>

namespace thalweg::surface {

/// What the land does where no river leaves it.
enum class Edge : std::uint8_t {
    open,    ///< it goes on beyond the grid: water leaves as if the neighbouring basins stood as high as ours
    closed,  ///< it ends: all its water goes to the given rivers
    coast,   ///< it ends at the sea, at height 0
    mainland ///< the sea where the mask says so, at height 0; beyond the grid it goes on
};

/// What given heights of rivers are to the land.
enum class RiverHeights : std::uint8_t {
    graded, ///< not asked for: rivers are graded like the rest
    soft,   ///< upper bounds: a river is lowered where its surroundings are lower
    fixed   ///< kept; where the surroundings cannot hold them up, the river runs on a wall
};

/// What varies over the land. Rasters on the rivers' grid, or without cells for none.
struct EquilibriumFields {
    Mask land;                 ///< 0: sea, which gets no height; every river cell is land
    Raster<float> uplift;      ///< > 0, only ratios count
    Raster<float> erodibility; ///< > 0, only ratios count (lithology)
};

/// Options of equilibrium().
struct EquilibriumParams {
    double theta = 0.38;               ///< [0.1, 0.9] concavity: slope ~ area^-theta
    double mean_slope_deg = 25.0;      ///< (0, 60] of the land's cells (Horn's slope), where relief is not given
    std::optional<double> relief_m;    ///< [m] > 0, from the lowest to the highest cell; instead of the mean slope
    double hillslope_cells = 1.0;      ///< [0.5, 100] length below which soil creep wins over water (Perron 2009)
    double floor_width = 0.04;         ///< [0, 1] half width of a valley floor [cells] over area [cells] ^ 0.4
    double roughness = 0.25;           ///< [0, 1] standard deviation of the logarithm of erodibility, as noise
    double longest_wave_cells = 360.0; ///< [4, ...] of that noise
    Edge edge = Edge::open;
    RiverHeights heights = RiverHeights::graded;
    bool bring_to_target = true; ///< given heights: solve again until the land around them has the mean slope or the
                                 ///< relief; else it stands as high as around graded rivers
    std::uint64_t seed = 7;
};

/// What equilibrium() returns.
struct EquilibriumTerrain {
    Raster<float> dem;                   ///< [m] NaN at sea
    Raster<flow::Direction> direction;   ///< where the water of each cell goes; no_data at sea
    std::vector<std::int64_t> shortened; ///< numbers of channel cells that are none any more: tips that stood perched
    std::vector<std::int64_t> walled;    ///< numbers of channel cells that stand on walls (fixed, soft)
    double max_lowered_m = 0.0;          ///< soft: greatest depth below the given heights
    double p95_lowered_m = 0.0;          ///< soft: 95th percentile of it over the channel cells with heights
    double target_share = 1.0;           ///< mean slope or relief that came out, over the target
    double rise = 0.0;                   ///< factor from the solver's heights (in cells) to metres, over the cell size
};

/// Draws the land that is in equilibrium with given rivers: everywhere uplift equals what running water cuts (K A^theta
/// S, with debris flows where A is small) less what soil creep brings (D lap z), with a cap on slopes, noise on
/// erodibility, and floors along rivers. Solved coarse to fine.
/// \pre rivers, at least one, whose water leaves on the border, the coast or in a sink; fields on their grid.
/// \param rivers the rivers
/// \param fields fields that vary over the land
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return water of a river cell goes to its receiver, by the steepest descent of the floats that are written, and land
/// beside rivers stands above every river cell it touches; all land has a strictly lower neighbour, so there is no
/// depression but a sink; lakes are level. Given heights may keep the land from a mean slope or relief: then it has the
/// nearest that was found. The lowest river end stands at 0 (given heights: where they say). The same bytes for any
/// number of threads.
/// \throws BadParameter
/// \throws BadInput channels that break their law, fields on another grid, not above 0 or with holes on land, no land,
/// a river at sea, given heights that rise
/// \throws Cancelled
///
/// Source: \cite perron2009 (hillslope length); \cite braun2013 (order); \cite barnes2014 (flood); \cite stock2003
/// (debris flows).
EquilibriumTerrain equilibrium(Channels const& rivers, EquilibriumFields const& fields = {},
                               EquilibriumParams const& params = {}, Run const& run = {});

} // namespace thalweg::surface
