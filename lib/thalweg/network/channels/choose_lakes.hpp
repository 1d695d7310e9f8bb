// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/network/channels/channels.hpp>

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
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return labels for flood_lakes, from 1 in the order of arcs, 0: no lake. Lakes keep three cells from one another and
/// from the grid's edge, so some are smaller. Random numbers are a hash of (seed, arc).
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput when there is not one area per arc
/// \throws Cancelled
Raster<std::int32_t> choose_lakes(ChannelsOfArcs const& drawn, std::vector<double> const& area_m2,
                                  ChooseLakesParams const& params = {}, Run const& run = {});

} // namespace thalweg::network
