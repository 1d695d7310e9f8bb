// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/network/elevation/set_heights.hpp>
#include <thalweg/network/order/count_streams.hpp>

namespace thalweg::pipeline {

/// What became of a network grown by Tokunaga's law.
struct TokunagaStory {
    network::StreamCounts tree; ///< of the tree as it was grown; empty for strokes
    std::int64_t placed = 0;    ///< links that found room
    std::int64_t dropped = 0;
};

/// What the network went through, for the report.
struct NetworkStory {
    std::int64_t particles = 0; ///< of the cluster (dla) or the forest
    std::int64_t walkers = 0;   ///< released for it
    std::optional<TokunagaStory> tokunaga;
    bool wide = false;                  ///< the cluster stopped at its greatest radius
    bool full = false;                  ///< the forest stopped where no particle found room
    bool cut = false;                   ///< the branch reached the grid's margin before the last particle
    std::int64_t arcs_traced = 0;       ///< before pruning
    std::int64_t arcs_kept = 0;         ///< by pruning; merged ones count once
    network::HeightReport heights = {}; ///< under modes that set heights
    bool heights_of_file = false;       ///< taken because the lines have them, not because they were asked for
    std::int64_t lowered_cells = 0;     ///< shared valley cells lowered to keep every path falling
    double max_lowered_m = 0.0;
    std::vector<Finding> repairs = {}; ///< of adopted lines, and outlets carried to the border
};

} // namespace thalweg::pipeline
