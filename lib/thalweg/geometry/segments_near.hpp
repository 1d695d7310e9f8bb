// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::geometry {

/// A segment of a polyline close to a point.
struct NearSegment {
    std::size_t line = 0;    ///< index of the polyline
    std::size_t segment = 0; ///< between vertices segment and segment + 1

    friend bool operator==(NearSegment const&, NearSegment const&) = default;
};

/// The point of segment ab nearest to p, and its position [0, 1] on the segment.
struct Foot {
    double along = 0.0;
    Vec2 at;
};
Foot foot_on(Vec2 a, Vec2 b, Vec2 p);

/// Tests three successive vertices of a line for a spike.
/// \param before,tip,after positions [m]
/// \param near_m [m] >= 0
/// \return the line turns back at the tip by more than near_m and runs within near_m of itself
bool is_spike(Vec2 before, Vec2 tip, Vec2 after, double near_m);

/// Finds the segments within a distance of every point.
/// \param points [m]
/// \param lines [m]
/// \param distance_m [m] >= 0
/// \param run progress, log, stop token and number of threads
/// \return by point, sorted by line and segment
/// \throws Cancelled
///
/// Source: CGAL, streamed segment trees.
std::vector<std::vector<NearSegment>> segments_near(std::vector<Vec2> const& points,
                                                    std::vector<std::vector<Vec2>> const& lines, double distance_m,
                                                    Run const& run = {});

} // namespace thalweg::geometry
