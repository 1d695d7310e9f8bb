// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/network/channels/channels.hpp>

// Idea: A lake is a set of cells that all drain to one outlet and are as high as it. The outlet is,
// of the river cells where water leaves the area for good, the one with the most river cells
// upstream; from there a breadth-first search gives each cell its receiver, so that ways through
// the lake are shortest and none is cut off. Rivers that would leave elsewhere run dry and are cut.
// choose_lakes invents areas: each grows from a river cell through noise, five times as easily
// along the river, to a size whose logarithm is uniform, and its shore is smoothed once.
// Source: ours: docs/algorithms/lake_flooding.md.
// Cost: a pass is O(grid) for labels, and O(c + l w) for c channel cells, l lake cells and ways of
// length w; one pass where no lake takes over another's river. One thread.
// Not for: levels that are asked for (surface/equilibrium gives them to outlets); depressions of a
// DEM (flow/condition.hpp); lakes with several outlets or with none.
// Example:
//     ChannelsOfArcs const drawn = channels(network, grid);
//     Raster<std::int32_t> const labels = choose_lakes(drawn, area_m2, {.share = 0.2, .seed = 3});
//     Flooded const flooded = flood_lakes(drawn, labels);
// More: docs/equilibrium.md, "Lakes".

namespace thalweg::network {

/// Options of choose_lakes().
struct ChooseLakesParams {
    double share = 0.1;             ///< [0, 1] share of the reaches with enough area that get a lake
    double min_area_cells = 2000.0; ///< [cells] >= 0, drainage area from which a reach may have a lake
    /// [4, ...] largest lake; a lake covers at least 16 cells and at most a fiftieth of its drainage area
    std::int64_t max_cells = 2000;
    std::uint64_t seed = 7;
};

/// Chooses reaches with lakes and shapes each lake: grown by noise from a river cell, faster along the river.
/// \param drawn channels of the network
/// \param area_m2 [m2] by arc: drainage area
/// \return labels for flood_lakes, from 1 in the order of arcs, 0: no lake. Lakes keep three cells from one another and
/// from the grid's edge, so some are smaller. Random numbers are a hash of (seed, arc).
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput when there is not one area per arc
Raster<std::int32_t> choose_lakes(ChannelsOfArcs const& drawn, std::vector<double> const& area_m2,
                                  ChooseLakesParams const& params = {}, Run const& run = {});

/// A lake in the channels.
struct Lake {
    std::int32_t label = 0;  ///< in the input raster
    std::int64_t outlet = 0; ///< number of the channel cell through which its water leaves; not part of the lake
    std::int64_t cells = 0;  ///< level cells
};

/// What flood_lakes() returns.
struct FloodedLakes {
    ChannelsOfArcs drawn; ///< with the cells of lakes; `level` is set
    std::vector<Lake> lakes;
    /// where: a cell of the lake; amount: a number. "lake_left_out" [cells]: no river runs through it, or fewer than
    /// four cells remain; "lake_cut" [cells]: removed at the grid's edge, beside another lake or a passing river;
    /// "lake_outlets" [rivers]: they left it and now begin below it, or returned to it and are left out
    std::vector<Finding> notes;
};

/// Adds lakes to channels: all cells of a lake drain to one outlet and have its height. The outlet is, of the river
/// cells where water finally leaves the lake, the one with the most river cells upstream. Lakes keep one cell from the
/// grid's edge, from one another (the higher label yields) and, except at the outlet, from rivers that do not enter
/// them.
/// \param drawn channels of the network
/// \param labels by cell, on the channels' grid: 0: no lake; separate 8-connected parts of a label are separate lakes
/// \return channels that keep their law; a lake's cells are 8-connected and drain by shortest paths to the outlet.
/// Prescribed heights: a lake takes its outlet's, its inflows are raised to it.
/// \throws BadInput for a raster on another grid or a label below 0
FloodedLakes flood_lakes(ChannelsOfArcs const& drawn, Raster<std::int32_t> const& labels, Run const& run = {});

/// One warning for all lakes that have not the levels asked.
/// \param lakes a note on each
/// \return "lakes_off_levels"; nothing without lakes
std::vector<Finding> lakes_off_levels(std::vector<Finding> const& lakes);

/// Notes on lakes that have not their levels, and a warning.
/// \param channels with lake_z [m], the levels asked
/// \param lakes in them
/// \param dem [m] with the lakes as they came out
/// \return a "lake_level" for each, with what keeps it up, and "lakes_off_levels"
std::vector<Finding> missed_levels(Channels const& channels, std::vector<Lake> const& lakes, Raster<float> const& dem);

} // namespace thalweg::network
