// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_lines.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// A grid divided by coastlines.
struct LandAndSea {
    Mask land; ///< 0: sea; without cells where the grid holds no sea
    std::int64_t sea_cells = 0;
    std::int64_t behind = 0; ///< river cells near a coastline, on its side that is land
    std::int64_t beyond = 0; ///< likewise, on its side that is sea
};

/// Divides a grid into land and sea by coastlines and rivers, both of which may leave it. Near a coastline its sides
/// decide; a cell farther away is like the nearest one that is decided, by a coastline or because a river runs there.
/// So beyond the ends of coastlines and in their gaps the coast goes midway between the sea and the rivers.
/// \param coastlines the coastlines
/// \param rivers the rivers
/// \param grid the grid
/// \param run progress, log, stop token and number of threads
/// \return water to the right of coastlines, as OpenStreetMap and NHD draw them, unless more river cells lie there; the
/// same mask for any number of threads.
/// \throws Cancelled
LandAndSea land_and_sea(RiverLines const& coastlines, RiverLines const& rivers, Grid const& grid, Run const& run = {});

/// Divides a grid where outlets that lie inside it count as the mouths of rivers at the sea: the sea begins before each
/// of them, in the direction in which its river ends; a cell farther away is like the nearest one that is decided, by
/// an outlet or because a river runs there. So the coast runs from outlet to outlet.
/// \pre a network of trees inside the grid.
/// \param network the network
/// \param grid the grid
/// \param run progress, log, stop token and number of threads
/// \return every river cell is land; without cells where no outlet lies inside.
/// \throws Cancelled
Mask land_behind_outlets(StreamNetwork const& network, Grid const& grid, Run const& run = {});

/// \pre a network inside the mask's grid.
/// \param land the cells of land; 0: sea
/// \param network the network
/// \return Land with all the cells rivers run through, and the cells around each of them but those around outlets
/// alone: so water cannot leave a river sideways into the sea.
Mask land_along_rivers(Mask land, StreamNetwork const& network);

} // namespace thalweg::network
