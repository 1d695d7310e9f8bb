// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>

namespace thalweg {

using ChannelId = std::int64_t; ///< number of a channel cell: 0, 1, ... from downstream; -1: none

/// The cells of the rivers and their receivers, around which equilibrium terrain is built. Law: each cell occurs once;
/// receiver[i] < i, so a list runs upstream; a cell and its receiver are D8 neighbours. The vectors are parallel.
struct Channels {
    Grid grid;
    std::vector<CellIndex> cell;     ///< index in the grid
    std::vector<ChannelId> receiver; ///< position in these vectors; -1: an outlet or sink
    std::vector<float> z;            ///< [m] prescribed heights, NaN: free; empty: all free
    std::vector<std::uint8_t> level; ///< 1: lake, as high as its receiver; empty: no lakes
    std::vector<float> lake_z = {};  ///< [m] level that a lake's outlet must have, NaN: any; empty: no lake has one
};

} // namespace thalweg
