// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/grid.hpp>
#include <thalweg/core/indexed.hpp>

namespace thalweg {

using ChannelId = std::int64_t; ///< number of a channel cell in its lists: 0, 1, ... downstream first; -1 for none

/// The cells in which rivers run and where the water of each goes: what equilibrium terrain is built around. Law: every
/// cell is there once; receiver[i] < i, so downstream comes first, or -1 where the water leaves the land (on the grid's
/// border or the coast) or ends in a sink; a cell and its receiver are neighbours, by side or corner. The vectors are
/// parallel.
struct Channels {
    Grid grid;
    Indexed<ChannelId, CellIndex> cell;     ///< index in the grid
    Indexed<ChannelId, ChannelId> receiver; ///< number in these lists, -1 for none
    Indexed<ChannelId, float> z;            ///< [m] heights that are asked, NaN for none; empty: none at all
    Indexed<ChannelId, std::uint8_t> level; ///< 1: a lake's, which stands as high as its receiver; empty: none
};

} // namespace thalweg
