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

/// Clips lines to a grid so that none runs along its edge: its outermost cells hold ends of lines only.
/// \param lines polylines [m], drawn downstream unless `runs` says otherwise
/// \param grid smaller than five cells a side: as clip_lines
/// \return lines inside that already do so are kept bit for bit. Others end one cell inside the edge and are drawn on
/// straight to it, with begins_at_edge and ends_at_edge; their parts beyond are added to `secondary`. One that leaves
/// and comes back within three cells stays whole, inside. Ends in neighbouring outermost cells are joined one cell
/// inside, unless both are heads.
RiverLines end_at_edge(RiverLines const& lines, Grid const& grid);

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

/// Keeps the artificial channels that rivers need: where a river ends at one, the shortest way through `channels` to
/// another river (against the drawn direction three times as long). Lines flow by their heights where these differ,
/// else as drawn; rivers with more ends than sources are drawn upstream.
/// \param rivers lines [m], with channels
/// \param snap_m [m] >= 0, ends closer than this meet; 0: 1e-6 of the box's diagonal
/// \return needed parts of channels are in `lines`, with a finding "connector" [m] each; all other parts are in
/// `secondary` by their reason; `channels` is empty
RiverLines keep_connectors(RiverLines rivers, double snap_m, Run const& run = {});

} // namespace thalweg::network
