// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>

#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/flow_field.hpp>

namespace thalweg::measure {

/// How straight the channels of a DEM run.
struct StraightChannels {
    std::int64_t longest_run = 0; ///< [steps] in one D8 direction
    std::int64_t reaches = 0;     ///< of reach_steps, one from each channel cell whose water goes on so far
    /// [0, 1] of the reaches stay within tolerance_cells of their chord; NaN: no reach
    double straight_share = std::numeric_limits<double>::quiet_NaN();
};

/// Options of straight_channels().
struct StraightChannelsParams {
    std::int64_t support_cells = 2000; ///< [1, ...] contributing area at which channels begin
    std::int64_t reach_steps = 60;     ///< [2, ...]
    double tolerance_cells = 1.5;      ///< [cells] >= 0
};

/// Measures how far channels run straight: valleys that follow the grid do so for hundreds of cells.
/// \param drainage flow field of the DEM
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return lengths in cells of the flow field
/// \throws BadParameter when a parameter is outside its range
/// \throws Cancelled
StraightChannels straight_channels(flow::FlowField const& drainage, StraightChannelsParams const& params = {},
                                   Run const& run = {});

} // namespace thalweg::measure
