// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/river_lines.hpp>

namespace thalweg::network {

/// What fill_heights() returns.
struct FilledHeights {
    RiverLines lines;
    std::int64_t filled = 0; ///< lines that had no heights
    std::int64_t first = 0;  ///< feature of the first of them
};

/// Gives lines without heights those that follow from the lines they meet, where others have heights.
/// \pre lines; slope > 0 [m/m]. A line has heights when all its vertices have, and not all such lines are level at the
/// same height.
/// \param lines the polylines
/// \param slope [m/m] > 0, slope
/// \return lines between two known heights linear by length; lines with one known end rise from it upstream or fall
/// from it downstream, taken as drawn, or the other way round where most lines with heights rise as drawn; a line that
/// meets none has at its lower end the height of the nearest known vertex. Without any heights, or with all: the lines
/// as they are. has_z is true where there are heights afterwards.
/// \throws BadParameter
FilledHeights fill_heights(RiverLines lines, double slope);

} // namespace thalweg::network
