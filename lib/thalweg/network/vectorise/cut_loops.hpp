// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/vec.hpp>

namespace thalweg::network {

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

} // namespace thalweg::network
