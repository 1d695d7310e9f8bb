// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

/// Private to this module.
namespace thalweg::surface {

/// Channels in the frame of a level, downstream first. The vectors are parallel.
struct RiverCells {
    std::vector<std::uint32_t> cell;    ///< index in the level
    std::vector<std::int32_t> receiver; ///< number in these lists, -1 for none
    std::vector<std::int8_t> way;       ///< to the receiver, as d8_steps
    std::vector<std::uint8_t> level;    ///< 1: as high as its receiver
    std::vector<float> asked;           ///< height, NaN for none; empty: none at all
    std::vector<std::int64_t> number;   ///< in the caller's Channels, -1: beyond its grid
};

/// The rivers on a grid of half as many cells a side: a coarse cell takes over the river cell in it that has the
/// fewest steps to its end (ties: the first), so that rivers stay trees. Widths are those of framed levels.
RiverCells coarsened(RiverCells const& fine, std::int64_t fine_width, std::int64_t coarse_width,
                     std::int64_t coarse_height);

} // namespace thalweg::surface
