// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/run/stage_log.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/growth/dla/grow_dla.hpp>
#include <thalweg/make/line_sources.hpp>
#include <thalweg/network/elevation/river_types.hpp>
#include <thalweg/network/order/order.hpp>
#include <thalweg/recipe/recipe.hpp>

namespace thalweg::make {

/// What became of a network grown by Tokunaga's law.
struct TokunagaStatistics {
    network::StreamCounts tree; ///< of the tree as it was grown; empty for strokes
    std::int64_t placed = 0;    ///< links that found room
    std::int64_t dropped = 0;
};

/// How a network came about, for the report.
struct NetworkStatistics {
    std::int64_t particles = 0; ///< of the cluster (dla) or the forest
    std::int64_t walkers = 0;   ///< released for it
    std::optional<TokunagaStatistics> tokunaga;
    bool wide = false;            ///< the cluster stopped at its greatest radius
    bool full = false;            ///< the forest stopped where no particle found room
    bool cut = false;             ///< the branch reached the grid's margin before the last particle
    std::int64_t arcs_traced = 0; ///< before pruning
    std::int64_t arcs_kept = 0;   ///< by pruning; merged ones count once
};

/// What a file of rivers holds beside the network.
struct RiverFile {
    std::vector<SecondaryLine> secondary; ///< lines that are not in the network
    AttributeTable attributes;            ///< of all lines
    RiverClues clues;                     ///< of all lines that tell something
    LineSources sources;                  ///< the lines in the network
    StreamNetwork imported;               ///< the network that was made of them, before outlets are carried
    double taken_m = 0.0;                 ///< [m] of the lines from which it was made, copies among them
    double lengthened = 1.0;              ///< by bends: length of the adopted network / that as it was drawn
};

/// Rivers in plan view, on their grid. The terrain gives them heights (Rivers).
struct Planform {
    Grid grid;
    StreamNetwork network;                       ///< arcs name their types where types has them
    network::RiverTypes types;                   ///< by arc; empty where the recipe asks for none
    std::optional<ElevatedNetwork> file_heights; ///< of the network, where the recipe takes the file's heights
    Mask land;                                   ///< 0: sea, which has no heights; without cells: no sea
    RiverFile file;                              ///< from which the rivers were imported
    NetworkStatistics statistics;
    std::vector<Finding> findings; ///< on rivers as they were grown, imported and carried to the border
    Timings timings_s;
};

/// The cluster of a recipe whose rivers are a branch of one.
/// \internal
growth::Cluster cluster_of(recipe::Recipe const& recipe, Run const& run);

} // namespace thalweg::make
