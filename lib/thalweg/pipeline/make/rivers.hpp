// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/network/elevation/assign_types.hpp>
#include <thalweg/network/order/count_streams.hpp>
#include <thalweg/pipeline/plan/plan.hpp>

namespace thalweg::pipeline {

/// Where rivers run on their grid, and how high, unless the terrain decides that.
struct Rivers {
    Grid grid;
    ElevatedNetwork network;   ///< without heights where they follow from a terrain in equilibrium
    RiverFile file;            ///< of which the rivers are
    Mask land;                 ///< 0: sea, which has no heights; without cells: all is land
    network::RiverTypes types; ///< by arc, where rivers have types; else empty
    NetworkOrders orders;      ///< where the network has heights, like the rest
    network::StreamCounts streams;
    Valley valley;
    NetworkStory story;
    Timings timings_s;
};

/// Grows or adopts the rivers of a plan, and gives them heights where these do not follow from the land.
/// \param plan a plan with [network]
/// \param run progress, log, stop token and number of threads
/// \return the rivers; none where the plan has no [network].
/// \throws BadParameter
/// \throws BadInput
/// \throws IoError
/// \throws Cancelled
Rivers make_rivers(Plan const& plan, Run const& run = {});

} // namespace thalweg::pipeline
