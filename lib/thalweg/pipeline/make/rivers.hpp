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

/// Statistics of a network grown by Tokunaga's law.
struct TokunagaStory {
    network::StreamCounts tree; ///< of the grown tree; empty for strokes
    std::int64_t placed = 0;    ///< links that found room
    std::int64_t dropped = 0;
};

/// Statistics of the network's construction, for the report.
struct NetworkStory {
    std::int64_t particles = 0; ///< of the cluster (dla) or the forest
    std::int64_t walkers = 0;   ///< released for it
    std::optional<TokunagaStory> tokunaga;
    bool wide = false;                  ///< the cluster stopped at its maximum radius
    bool full = false;                  ///< the forest stopped where no particle found room
    bool cut = false;                   ///< the branch reached the grid's margin before the last particle
    std::int64_t arcs_traced = 0;       ///< before pruning
    std::int64_t arcs_kept = 0;         ///< after pruning; merged ones count once
    network::HeightReport heights = {}; ///< for methods that set heights
    bool heights_of_file = false;       ///< used because the lines have them, not because they are requested
    std::int64_t lowered_cells = 0;     ///< shared valley cells lowered so that every path falls
    double max_lowered_m = 0.0;
    std::vector<Finding> repairs = {}; ///< of imported lines, and outlets extended to the border
};

/// Data of a file of rivers besides the network.
struct RiverFile {
    std::vector<SecondaryLine> secondary; ///< lines left out of the network
    AttributeTable attributes;            ///< of all lines
    LineSources sources;                  ///< the lines in the network
    StreamNetwork adopted;                ///< the imported network, before outlets are extended
    double taken_m = 0.0;                 ///< [m] of the imported lines, duplicates included
    double lengthened = 1.0;              ///< by meanders: length of the imported network / as drawn
};

/// The courses of rivers on their grid, with heights unless the terrain determines them.
struct Rivers {
    Grid grid;
    ElevatedNetwork network;   ///< without heights if they follow from a terrain in equilibrium
    RiverFile file;            ///< source of the rivers
    Mask land;                 ///< 0: sea, which has no heights; without cells: all land
    network::RiverTypes types; ///< by arc; empty: rivers have no types
    NetworkOrders orders;      ///< if the network has heights, like the following
    network::StreamCounts streams;
    Valley valley;
    NetworkStory story;
    Timings timings_s;
};

/// Creates the rivers from the recipe's source.
/// \param plan with [network]
/// \return with heights, unless these follow from the terrain; none if the plan has no [network]
Rivers make_rivers(Plan const& plan, Run const& run = {});

} // namespace thalweg::pipeline
