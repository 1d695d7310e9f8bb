// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/network/channels/channels.hpp>

namespace thalweg::network {

/// A lake as it came to lie in the channels.
struct Lake {
    std::int32_t label = 0;  ///< in the raster it came from
    std::int64_t outlet = 0; ///< number of the channel cell through which its water leaves; not level itself
    std::int64_t cells = 0;  ///< level ones
};

/// What flood_lakes() returns.
struct Flooded {
    ChannelsOfArcs drawn; ///< with the lakes' cells, and level set
    std::vector<Lake> lakes;
    std::vector<Finding> notes; ///< where: a cell of the lake. "lake_left_out": no river runs through it, or fewer than
                                ///< four cells are left (amount: its cells); "lake_cut": cells taken off it at the
                                ///< grid's edge, beside another lake or a river that passes by (their number);
                                ///< "lake_outlets": rivers that left it and begin below it now, or came back to it and
                                ///< are left out (their number)
};

/// Lays lakes into channels: every cell of a lake drains to its one outlet, and stands as high.
/// \pre channels and a raster of labels on their grid, 0 for none; parts of a label that do not touch are lakes of
/// their own.
/// \param drawn what was drawn
/// \param labels labels by cell; 0: none
/// \param run progress, log, stop token and number of threads
/// \return channels that keep their law; of each lake the cells that hang together by sides or corners, each flowing to
/// the next on a shortest way to the outlet. The outlet: of the river cells from which water leaves the lake for good,
/// the one with the most river cells above it. Lakes keep a cell away from the grid's edge and from each other (the
/// greater label gives way), and but for the outlet from rivers that do not flow into them. Heights that are given:
/// lakes take the outlet's, what flows into them is raised to it.
/// \throws BadInput for a raster on another grid or a label below 0
/// \throws Cancelled
Flooded flood_lakes(ChannelsOfArcs const& drawn, Raster<std::int32_t> const& labels, Run const& run = {});

} // namespace thalweg::network
