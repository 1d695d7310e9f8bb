// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/vec.hpp>

namespace thalweg::network {

/// A line without the ways round that bring it back to where it was.
struct CutLine {
    std::vector<Vec3> line;
    double cut_m = 0.0; ///< length of what was left out
};

/// Cuts loops and spikes off a line.
/// \pre a line of finite coordinates in plan.
/// \param line [m] the vertices
/// \param near_m [m] >= 0, a line that turns back and comes this close to where it was has a spike
/// \return a line that neither touches nor crosses itself, with the same ends; heights of vertices where it crossed are
/// interpolated; a line without loops as it is, less repeated vertices. A ring shrinks to a point.
/// \throws BadInput when a coordinate is not finite
CutLine cut_loops(std::vector<Vec3> const& line, double near_m = 0.0);

} // namespace thalweg::network
