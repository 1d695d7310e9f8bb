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
    std::vector<Finding> notes; ///< outlets left out or added, land without rivers
    std::int64_t outlets = 0;   ///< number with a tree
    std::int64_t particles = 0;
    std::int64_t walkers = 0;
    ForestStop stop = ForestStop::full;
};

/// Grows rivers from outlets on a coast until the land is full of them.
/// \param land 0: sea
/// \param outlets cells of the coast (coast_cells)
/// \param params as grow_forest; step_cells in [4, 100]
/// \param run progress, log, stop token and number of threads
/// \return one tree per outlet, on land; vertices are cell centres; rivers of two trees leave two cells free between
/// them. notes: "crowded_outlet" (left out: too close to another river, or the land is too narrow), "added_outlet" (on
/// land from which no river reaches an outlet), "dry_land" (an island without room for a river; amount: [cells])
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput for no land, an outlet off the coast or no room for any river
/// \throws Cancelled
PlantedForest plant_forest(Mask const& land, std::vector<Cell> const& outlets, ForestParams const& params = {},
                           Run const& run = {});

} // namespace thalweg::network
