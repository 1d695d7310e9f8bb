// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/channels.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

// Idea: Coastlines of map data have gaps and may be drawn either way, but rivers know where land
// is. Near a coastline the side of the nearest segment decides; the side on which more river cells
// lie is the land. All other cells take what the nearest decided cell is (a distance transform), so
// that a gap is closed by a line midway between sea and rivers. Without coastlines, a fan of cells
// beyond each outlet inside the grid is sea, in the direction of its river, and the rest follows in
// the same way: the coast runs from mouth to mouth.
// Source: ours. The nearest cells come from core/cells.hpp, nearest_cells (Meijster et al. 2000).
// Cost: O(cells), besides O(length of coastlines) with a constant of some hundred cells a segment.
// The distance transform runs on all cores.
// Not for: a mask that exists (surface.mask of a recipe), lakes (network/channels/lakes.hpp), or
// seas without a river or coastline near: then nothing is decided, and the mask is empty.
// Example:
//     LandAndSea const divided = land_and_sea(coastlines, lines, grid);
//     Mask const land = land_along_rivers(divided.land, network); // no river drains sideways
// More: docs/river_files.md, "Coastlines and the sea".

namespace thalweg::network {

/// A grid divided into land and sea.
struct LandAndSea {
    Mask land; ///< 0: sea; empty if the grid has no sea
    std::int64_t sea_cells = 0;
    std::int64_t behind = 0; ///< river cells near a coastline, on its land side
    std::int64_t beyond = 0; ///< as behind, on its sea side
};

/// Divides a grid into land and sea by coastlines and rivers. Near a coastline its sides decide; a cell farther away is
/// like the nearest decided one: beside a coastline, or a river's. So where coastlines have gaps the coast runs midway
/// between sea and rivers.
/// \param coastlines,rivers lines [m]; both may leave the grid
/// \param grid to be divided
/// \return sea to the right of coastlines, as OpenStreetMap and NHD draw them, unless more river cells lie there; the
/// same mask for any number of threads
LandAndSea land_and_sea(RiverLines const& coastlines, RiverLines const& rivers, Grid const& grid, Run const& run = {});

/// Divides a grid into land and sea, with outlets inside the grid as river mouths: the sea begins beyond each outlet,
/// in the direction of its river; any other cell is like the nearest decided one. So the coast runs from outlet to
/// outlet.
/// \param network a forest inside the grid
/// \param grid to be divided
/// \return 0: sea; every river cell is land; empty if no outlet lies inside
Mask land_behind_outlets(StreamNetwork const& network, Grid const& grid, Run const& run = {});

/// Adds to the land all river cells and their neighbours, except neighbours of outlets alone: no river then drains
/// sideways into the sea.
/// \param land 0: sea
/// \param network inside the mask's grid
/// \return 0: sea
Mask land_along_rivers(Mask land, StreamNetwork const& network);

/// Whether the gaps of a DEM are the sea: nine of ten rivers that end within two cells of one do so within 10 m of
/// height 0.
/// \param land 0: a gap
/// \param channels rivers with heights, on the mask's grid
/// \return false where no river ends beside a gap
bool gaps_are_sea(Mask const& land, Channels const& channels);

} // namespace thalweg::network
