// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::geometry {

/// A point where polylines meet, or one touches itself.
struct Crossing {
    std::size_t line = 0;    ///< index of the polyline
    std::size_t segment = 0; ///< index of its segment: between vertices segment and segment + 1
    double along = 0.0;      ///< [0, 1] position on the segment, exact and rounded once; 0 or 1 at its vertices
    Vec2 at;                 ///< [m] the exact intersection, rounded once; the vertex itself where it is one

    friend bool operator==(Crossing const&, Crossing const&) = default;
};

/// Finds every point where polylines meet: crossings, touching ends and vertices, ends of overlaps.
/// \param lines [m] finite coordinates; repeated vertices count once, a polyline of one repeated point is that point,
/// one of fewer than two vertices is skipped
/// \param run progress, log, stop token and number of threads
/// \return for each point one entry per polyline and segment through it, sorted by line, segment and position, with the
/// same `at` bit for bit; the common vertex of consecutive segments does not count, unless they fold back
/// \throws BadInput when a coordinate is not finite
/// \throws Cancelled
///
/// Source: CGAL, exact predicates and constructions.
std::vector<Crossing> crossings(std::vector<std::vector<Vec2>> const& lines, Run const& run = {});

} // namespace thalweg::geometry
