// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/grid.hpp>

namespace thalweg {

/// The cells of the rivers and their receivers, around which equilibrium terrain is built. Law: each cell occurs once;
/// receiver[i] < i, so a list runs upstream; a cell and its receiver are D8 neighbours. The vectors are parallel.
struct Channels {
    Grid grid;
    std::vector<std::int64_t> cell;     ///< index in the grid
    std::vector<std::int64_t> receiver; ///< position in these vectors; -1: an outlet or sink
    std::vector<float> z;               ///< [m] prescribed heights, NaN: free; empty: all free
    std::vector<std::uint8_t> level;    ///< 1: lake, as high as its receiver; empty: no lakes
};

} // namespace thalweg
