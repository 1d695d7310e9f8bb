// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::measure {

/// Where the water of each cell goes (D8).
struct Drainage {
    Raster<std::int8_t> direction;   ///< 0..7 clockwise from the east (E, SE, S, SW, W, NW, N, NE); -1 leaves the grid; -2 no data
    Raster<std::int64_t> area_cells; ///< cells that drain through a cell, itself included
    std::int64_t pits = 0;           ///< cells in depressions (below the level at which they spill)
    double pit_volume_m3 = 0.0;
};

/// D8 directions and contributing areas of any DEM: steepest descent, through depressions and flats by priority-flood.
/// Gives: every cell with data drains off the grid (or into no-data); no cycle. Source: O'Callaghan and Mark 1984;
/// Barnes, Lehman and Mulla 2014.
Drainage drain(Raster<float> const& dem, Run const& run = {});

/// Contributing areas [m2] of a network's arcs and nodes.
struct ContributingAreas {
    std::vector<double> us_area_m2; ///< by arc, at its upstream end
    std::vector<double> ds_area_m2; ///< by arc, at its downstream end (just above a confluence)
    std::vector<double> node_m2;    ///< by node
    char const* source = "nearest"; ///< "nearest" or "d8", for the run table
};

/// Without a DEM: each cell belongs to the network cell nearest by city-block distance (ties: lower index).
ContributingAreas areas_nearest(StreamNetwork const& network, Grid const& grid, Run const& run = {});

/// With a DEM: its D8 accumulation at the arcs' end cells.
ContributingAreas areas_d8(StreamNetwork const& network, Drainage const& drainage);

} // namespace thalweg::measure
