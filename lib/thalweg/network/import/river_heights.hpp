// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/river_files.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::network {

/// What without_placeholders() returns.
struct WithoutPlaceholders {
    RiverLines lines;
    std::int64_t vertices = 0; ///< that lost one
    std::int64_t zeros = 0;    ///< of them, those whose placeholder was 0
    std::int64_t first = 0;    ///< feature of the first of them
    Vec2 at = {};              ///< [m] its position
};

/// Removes heights that stand for missing ones. These are -9999 m and less; and 0 where programs that must write a
/// height wrote it for want of one, as GDAL does for positions of two numbers at which other tools have cut a line:
/// - anywhere, where a line of the file falls to exactly 0 between two vertices above 1 m;
/// - at an end of a line: where another line has another height; where two or more lines end and rise from it; where
///   both ends are 0 and the line rises above 1 m between; where the rest of the line falls away from it.
/// A free end that its line falls to is a mouth at 0 and stays, in a file with zeros of these kinds unless the last
/// step is five times as steep as any other; so does one that lines share, if they all fall to it and either are all
/// drawn to it (or from it) or have last steps at most twice as steep as any other.
/// \param lines any
/// \return NaN in their place, in lines and channels; has_z is false where there were any
WithoutPlaceholders without_placeholders(RiverLines lines);

/// What fill_heights() returns.
struct FilledHeights {
    RiverLines lines;
    std::int64_t filled = 0; ///< lines that lacked heights at vertices
    std::int64_t partly = 0; ///< of them, those that had some
    std::int64_t first = 0;  ///< feature of the first of them
};

/// Derives missing heights from those of the same line and of the lines it meets. Known heights stay. Heights that are
/// one and the same everywhere are none.
/// \param lines with heights at some vertices
/// \param slope [m/m] > 0, the greatest beyond known heights
/// \return between two known heights linear by length, also through an end without height at which lines with heights
/// meet; from one to a free end as the line's other heights fall; without such in drawn direction or, if most lines
/// with heights rise as drawn, against it; by at most `slope` and the mean of all lines with heights. A line that
/// neither has nor meets one has at its lower end the height of the nearest known vertex. Without any heights, or with
/// all: the lines unchanged.
/// \throws BadParameter when slope is outside its range
FilledHeights fill_heights(RiverLines lines, double slope);

/// As fill_heights(); where the known heights are one and the same, the others get it too. Without any they stay NaN.
RiverLines with_all_heights(RiverLines lines, double slope);

/// Gives heights to the vertices of a line that have none.
/// \param line vertices [m]
/// \return between two known heights linear by length, beyond the last one the same; without any: unchanged
std::vector<Vec3> with_heights_between(std::vector<Vec3> line);

} // namespace thalweg::network
