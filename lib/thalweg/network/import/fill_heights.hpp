// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/river_files.hpp>

namespace thalweg::network {

/// What fill_heights() returns.
struct FilledHeights {
    RiverLines lines;
    std::int64_t filled = 0; ///< lines that had no heights
    std::int64_t first = 0;  ///< feature of the first of them
};

/// Derives the heights of lines without them from the lines they meet. A line has heights when all its vertices have,
/// and not all such lines have one and the same height.
/// \param lines with heights in some
/// \param slope [m/m] > 0, for lines with fewer than two known ends
/// \return between two known heights linear by length; from one known end by `slope`, in drawn direction or, if most
/// lines with heights rise as drawn, against it; a line that meets none has at its lower end the height of the nearest
/// known vertex. Without any heights, or with all: the lines unchanged.
/// \throws BadParameter when slope is outside its range
FilledHeights fill_heights(RiverLines lines, double slope);

} // namespace thalweg::network
