// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/network/growth/forest/grow_forest.hpp>

namespace thalweg::network {

/// What plant_forest() returns.
struct PlantedForest {
    StreamNetwork network;
    std::vector<Finding> notes; ///< outlets that were left out or added, land without rivers
    std::int64_t outlets = 0;   ///< that have a tree
    std::int64_t particles = 0;
    std::int64_t walkers = 0;
    ForestStop stop = ForestStop::full;
};

/// Grows rivers from outlets on a coast into the land until it is full of them.
/// \pre land, 0 for sea; outlets, cells of its coast (coast_cells); params as grow_forest, step_cells [4, 100].
/// \param land the cells of land; 0: sea
/// \param outlets where rivers end
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return a network on land of one tree an outlet, which is the centre of its cell; vertices are centres of cells, and
/// rivers of two trees keep two cells free between them. notes: "crowded_outlet" (left out: its river would come too
/// near to another's, or the land is too narrow), "added_outlet" (on land from which no river finds one), "dry_land"
/// (an island without room for a river; amount: its cells).
/// \throws BadParameter
/// \throws BadInput for no land, an outlet off the coast or no room for any river
/// \throws Cancelled
PlantedForest plant_forest(Mask const& land, std::vector<Cell> const& outlets, ForestParams const& params = {},
                           Run const& run = {});

} // namespace thalweg::network
