// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <thalweg/core/channels.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/direction.hpp>
#include <thalweg/surface/equilibrium/features.hpp>
#include <thalweg/surface/strata/strata.hpp>

// Idea: Landscape evolution to its end. Uplift raises, rivers cut K A^theta S, debris flows cut
// where few cells drain, creep rounds crests; where the three balance heights no longer change.
// That state is approached directly, without time steps: for fixed flow directions the balance is
// linear in heights, so one sweep, receivers first, sets each cell from its receiver's new height
// in closed form. A round turns cells to their steepest neighbour, accumulates areas, sets the
// rivers and sweeps; some rounds at each level, from a grid of about forty cells to the finest, let
// large valleys settle before small ones. Rivers keep their cells and receivers, but for heads that
// would stand perched. No cell is ever set lower than a step above its receiver, so no depression
// can form and none is filled. Heights are scaled to the target slope or relief at the end.
// Source: ours: docs/decisions/0015-equilibrium.md, 0022 to 0026, 0039. Parts: creep length Perron et
// al. 2009; stack order Braun and Willett 2013; flood Barnes et al. 2014; debris flows Stock and
// Dietrich 2003.
// Cost: O(n) a round; levels add a third. docs/performance.md: 408 ns and 21 bytes a cell for 2048
// x 2048, 15 times D8 of the result. All cores, but for the flood and the rivers. Given heights
// solve twice, with a target slope up to seven times, with known points four times.
// Not for: rivers with known heights that the terrain shall follow (rebuild.hpp). Rounds are
// counted, so the steady state is approached, not reached. It knows no terraces, fans, landslides
// or glaciers.
// Example:
//     Channels const rivers = drawn_channels; // network::channels(network, grid).channels
//     EquilibriumTerrain const terrain = equilibrium(rivers, {}, {.mean_slope_deg = 22.0});
//     Raster<float> const& dem_m = terrain.dem;
// More: docs/algorithms/equilibrium_levels.md; docs/equilibrium.md.

namespace thalweg::surface {

/// Boundary conditions of equilibrium terrain.
enum class Edge : std::uint8_t {
    open,    ///< terrain continues beyond the grid: water leaves as if neighbouring basins were as high
    closed,  ///< terrain ends at the grid: all water flows to the input rivers
    coast,   ///< terrain ends at the sea, at height 0
    mainland ///< the sea, at height 0, where the mask is 0; terrain continues beyond the grid
};

/// How prescribed heights of rivers are used.
enum class RiverHeights : std::uint8_t {
    graded, ///< not used: rivers are graded like other channels
    soft,   ///< upper bounds: a river is lowered where its surroundings are lower
    fixed   ///< kept; where the surroundings are lower, the river runs on a wall
};

/// Treatment of the heads of graded rivers that would stand above their surroundings.
enum class Heads : std::uint8_t {
    cut, ///< they become terrain
    kept ///< rivers are lowered there, and erodibility below them is reduced
};

/// Fields that vary over the terrain, on the rivers' grid; empty: none.
struct EquilibriumFields {
    Mask land;                         ///< 0: sea, without heights; every river cell is land
    Raster<float> uplift;              ///< > 0, only ratios count
    Raster<float> erodibility;         ///< > 0, only ratios count (lithology)
    std::vector<FeatureCell> features; ///< by cell, each once; on rivers and the sea they have no effect
    Strata strata;                     ///< layers of rock, above the lowest end of a river
};

/// Options of equilibrium().
struct EquilibriumParams {
    double theta = 0.38;            ///< [0.1, 0.9] concavity index: slope ~ area^-theta
    double mean_slope_deg = 25.0;   ///< (0, 60] mean over cells (Horn's slope), unless relief_m is set; in layers that
                                    ///< which rock without layers would have
    std::optional<double> relief_m; ///< [m] > 0, highest minus lowest cell; replaces the mean slope
    /// (0, 1) in layers: of land that reaches the bottom of the cap rock (cap_rock()) or more; replaces the mean slope
    std::optional<double> cap_share;
    /// [m^0.9] > 0 greatest normalised steepness of the main stems of graded rivers, for a concavity of 0.45: where the
    /// mean slope makes them steeper, all heights are lowered to it; none: not bounded. Nothing with relief_m.
    std::optional<double> steepness;
    double hillslope_m = 15.0;        ///< [m] >= 0 length below which soil creep dominates (Perron 2009)
    double debris_area_m2 = 45'000.0; ///< [m²] >= 0 drainage area below which debris flows cut (Stock 2003)
    double floor_width_km = 0.009; ///< [km] [0, 1] half width of a valley floor where 1 km² drains; grows as area^0.42
                                   ///< up to 200 km²
    double roughness = 0.22;       ///< [0, 1] standard deviation of log erodibility, as noise
    double longest_wave_m = 10'800.0; ///< [m] > 0 longest wavelength of that noise
    double grain = 5.0;               ///< [1, 20] ratio of the extents of erodibility noise along and across its strike
    std::optional<double> strike_deg; ///< [degrees] of that noise, clockwise from north; none: from the seed
    /// [1, 5] with an open boundary: coarse levels are solved on terrain wider than the grid by this factor; 1: on the
    /// grid alone
    double region = 3.0;
    bool inflow = true; ///< water of the region may enter the grid; false: beyond an open edge lie valleys as low as
                        ///< the grid's own, to which land drains that no river reaches
    Heads heads = Heads::cut;
    Edge edge = Edge::open;
    RiverHeights heights = RiverHeights::graded;
    /// with prescribed heights or levels of lakes: solve again until the terrain has the target slope or relief; false:
    /// heights have the scale that they have without
    bool bring_to_target = true;
    std::uint64_t seed = 7;
};

/// Water that enters the grid from the region.
struct RegionInflow {
    std::int64_t cell = 0;       ///< on the border of the grid
    std::int64_t area_cells = 0; ///< that it drains beyond the grid
};

/// What equilibrium() returns.
struct EquilibriumTerrain {
    Raster<float> dem;                   ///< [m] NaN: sea
    Raster<flow::Direction> direction;   ///< D8 flow directions; no_data at sea
    std::vector<std::int64_t> shortened; ///< numbers of channel cells removed because they were perched (tips)
    std::int64_t graded_heads = 0;       ///< of these tips: pieces that would have had to lie in trenches
    /// numbers of channel cells on walls (fixed, soft, heads kept; else those in and below lakes with levels)
    std::vector<std::int64_t> walled;
    double max_lowered_m = 0.0;        ///< soft: largest lowering below prescribed heights
    double p95_lowered_m = 0.0;        ///< soft: its 95th percentile over channel cells with heights
    bool in_region = false;            ///< whether coarse levels were solved on a region
    std::vector<RegionInflow> inflows; ///< of 1000 cells or more, by cell
    double target_share = 1.0;         ///< mean slope or relief reached / target
    double rise = 0.0;                 ///< height [m] of one unit of the solver / cell size
    /// [m^0.9] normalised steepness of the main stems of graded rivers, those of larger basins more; NaN: not graded
    double steepness = std::numeric_limits<double>::quiet_NaN();
    double strata_shift_m = 0.0; ///< by which layers lie lower than asked, as rivers fall beyond an open edge
    double cap_share =
        std::numeric_limits<double>::quiet_NaN(); ///< [0, 1] of land that reaches the cap rock; NaN: none
    std::int64_t held_back = 0;                   ///< cells at the greatest height that land in layers may have
    bool is_bounded = false; ///< by the greatest steepness, so that the mean slope is less than its target
};

/// Builds terrain in equilibrium with given rivers: uplift equals fluvial incision (K A^theta S, debris flows where A
/// is small) minus soil creep (D lap z), with a limit on slopes, noise on erodibility, and valley floors. Solved coarse
/// to fine.
/// \pre Water leaves at the border, the coast or in a sink.
/// \param rivers at least one
/// \param fields sea, uplift and erodibility
/// \return as float32, river cells drain to their receivers by steepest descent and lie below the terrain beside them;
/// every land cell has a strictly lower neighbour, so the only depressions are sinks; lakes are level. Prescribed
/// heights may prevent the target slope or relief: then the nearest found. The lowest river end is at 0 unless
/// prescribed. Lakes with levels have them exactly, or the lowest height above from which water falls to the next lake
/// with a level and to the river's end; what is prescribed for rivers below and above yields. The same bytes for any
/// number of threads.
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput where layers meet prescribed heights, known points or levels of lakes; for channels that break their law, fields on another grid, not above 0 or with holes on land, no
/// land, a river at sea, prescribed heights that rise, or a level that is infinite or within a lake
///
/// Source: \cite perron2009 (hillslope length); \cite braun2013 (order); \cite barnes2014 (flood); \cite stock2003
/// (debris flows).
EquilibriumTerrain equilibrium(Channels const& rivers, EquilibriumFields const& fields = {},
                               EquilibriumParams const& params = {}, Run const& run = {});

} // namespace thalweg::surface
