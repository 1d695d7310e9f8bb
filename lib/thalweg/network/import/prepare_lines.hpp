// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::network {

/// Clips lines to a grid.
/// \param lines polylines [m]
/// \param grid clips at its outer edge
/// \return the parts inside, in order; a line that leaves and returns becomes several with the same feature. Vertices
/// inside are kept bit for bit; new ones lie exactly on the edge, with interpolated heights. What lies beyond the edge
/// is added to `secondary`.
RiverLines clip_lines(RiverLines const& lines, Grid const& grid);

/// Cuts lines where they leave the marked cells of a grid.
/// \param lines polylines [m], which clip_lines has cut at the grid's edge
/// \param land 0: no river may run there
/// \return as above; new vertices lie in the middle of what a line runs through the last marked cell
RiverLines clip_lines(RiverLines const& lines, Mask const& land);

/// A line without loops and spikes.
struct CutLine {
    std::vector<Vec3> line;
    double cut_m = 0.0; ///< length of the removed parts
};

/// Removes loops and spikes from a line.
/// \param line vertices [m], finite in plan
/// \param near_m [m] >= 0, a line that turns back and comes this close to itself has a spike
/// \return neither touches nor crosses itself; the ends stay, heights at crossings are interpolated, repeated vertices
/// are removed. A ring shrinks to a point.
/// \throws BadInput when a coordinate is not finite
CutLine cut_loops(std::vector<Vec3> const& line, double near_m = 0.0);

/// What without_placeholders() returns.
struct WithoutPlaceholders {
    RiverLines lines;
    std::int64_t vertices = 0; ///< that lost one
    bool zeros = false;        ///< whether 0 was one
};

/// Removes heights that stand for missing ones: -9999 m and less; and 0 in all lines, where a line falls to exactly 0
/// between two vertices above 1 m, as formats do that cannot leave out single heights.
/// \param lines any
/// \return NaN in their place; has_z is false where there were any
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
/// \param slope [m/m] > 0, for lines with fewer than two known ends
/// \return between two known heights linear by length; from one to a free end by `slope`, in drawn direction or, if
/// most lines with heights at all vertices rise as drawn, against it; a line that neither has nor meets one has at its
/// lower end the height of the nearest known vertex. Without any heights, or with all: the lines unchanged. \throws
/// BadParameter when slope is outside its range
FilledHeights fill_heights(RiverLines lines, double slope);

/// Gives heights to the vertices of a line that have none.
/// \param line vertices [m]
/// \return between two known heights linear by length, beyond the last one the same; without any: unchanged
std::vector<Vec3> with_heights_between(std::vector<Vec3> line);

/// Keeps the artificial channels that rivers need: where a river ends at one, the shortest way through `channels` to
/// another river (against the drawn direction three times as long). Lines flow by their heights where these differ,
/// else as drawn; rivers with more ends than sources are drawn upstream.
/// \param rivers lines [m], with channels
/// \param snap_m [m] >= 0, ends closer than this meet; 0: 1e-6 of the box's diagonal
/// \return needed parts of channels are in `lines`, with a finding "connector" [m] each; all other parts are in
/// `secondary` by their reason; `channels` is empty
RiverLines keep_connectors(RiverLines rivers, double snap_m, Run const& run = {});

} // namespace thalweg::network
