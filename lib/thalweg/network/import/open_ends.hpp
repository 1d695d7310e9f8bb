// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \internal

#include <vector>

#include <thalweg/core/features.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// An outlet inside the grid that lies nearer to a river of another basin than to the border.
struct GapBelow {
    NodeId outlet = 0;
    double gap_m = 0.0; ///< [m] to that river, in plan
};

/// Finds the gaps below outlets: of at most 2 cells to another river, or to one that begins there wider ones; away from
/// the mouths of those rivers, because at a sea or a lake they end side by side.
/// \param network a forest
/// \param grid of its frame and cells
/// \param most_cells [cells] >= 2, the widest gap
/// \return at most one an outlet, the narrowest, in the order of outlets
std::vector<GapBelow> gaps_below(StreamNetwork const& network, Grid const& grid, double most_cells,
                                 Run const& run = {});

/// A place that rivers end around, and where another one begins.
struct Hollow {
    NodeId source = 0;        ///< of the river that begins there
    std::vector<NodeId> ends; ///< outlets, ascending
    double farthest_m = 0.0;  ///< [m] from the source to the farthest of them
};

/// Finds the places that rivers of other basins run towards and end at, and one begins at that leads away: one within
/// 50 cells, or several nearer than to the border, with nothing drawn between.
/// \param network a forest
/// \param grid of its frame and cells
/// \return by source, ascending; an outlet belongs to one place at most
std::vector<Hollow> hollows(StreamNetwork const& network, Grid const& grid, Run const& run = {});

/// The distance to the nearest lake.
/// \param p [m]
/// \param lakes each with an outer ring; islands are not looked at
/// \return [m] 0: within a lake; infinity without lakes
double distance_to_lakes(Vec2 p, std::vector<Polygon> const& lakes);

} // namespace thalweg::network
