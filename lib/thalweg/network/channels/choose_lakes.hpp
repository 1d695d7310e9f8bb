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
    double share = 0.1;             ///< [0, 1] of the reaches with enough area that get a lake
    double min_area_cells = 2000.0; ///< [0, ...] drainage area from which a reach may have one: lakes are cells
    std::int64_t max_cells = 2000;  ///< [4, ...] largest lake; none is larger than a fiftieth of its drainage area,
                                    ///< nor smaller than 16 cells
    std::uint64_t seed = 7;
};

/// Chooses reaches that run through a lake, and its shape: grown from a cell of the river by noise, faster along it.
/// \pre channels and by arc its drainage area [m2].
/// \param drawn what was drawn
/// \param area_m2 [m2] drainage area by arc
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return labels for flood_lakes, from 1 in the order of arcs; lakes keep three cells from one another and from the
/// grid's edge, so that some find less room. Random numbers are a hash of (seed, arc).
/// \throws BadParameter
/// \throws BadInput for areas of other arcs
/// \throws Cancelled
Raster<std::int32_t> choose_lakes(ChannelsOfArcs const& drawn, std::vector<double> const& area_m2,
                                  ChooseLakesParams const& params = {}, Run const& run = {});

} // namespace thalweg::network
