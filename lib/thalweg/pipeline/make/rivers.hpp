// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/network/elevation/river_types.hpp>
#include <thalweg/network/elevation/set_heights.hpp>
#include <thalweg/network/order/order.hpp>
#include <thalweg/pipeline/make/line_sources.hpp>
#include <thalweg/pipeline/plan/plan.hpp>

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

/// What a file of rivers holds beside the network.
struct RiverFile {
    std::vector<SecondaryLine> secondary; ///< lines that are not in the network
    AttributeTable attributes;            ///< of all lines
    LineSources sources;                  ///< the lines in the network
    StreamNetwork adopted;                ///< the network that was made of them, before outlets are carried
    double taken_m = 0.0;                 ///< [m] of the lines from which it was made, copies among them
    double lengthened = 1.0;              ///< by bends: length of the adopted network / that as it was drawn
};

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
/// \return the rivers; none where the plan has no [network].
Rivers make_rivers(Plan const& plan, Run const& run = {});

} // namespace thalweg::pipeline
