// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::geometry {

/// A point where two polylines meet, or where one touches itself.
struct Crossing {
    std::size_t line = 0;    ///< index of the polyline
    std::size_t segment = 0; ///< index of its segment: between vertices segment and segment + 1
    double along = 0.0;      ///< [0,1] place on the segment, exact and rounded once; 0 or 1 where it is its vertex
    Vec2 at;                 ///< [m] the exact intersection, rounded once; the vertex itself where it is one

    friend bool operator==(Crossing const&, Crossing const&) = default;
};

/// Every point where polylines meet: proper crossings, touching ends and vertices, ends of overlaps.
/// \param lines polylines of finite coordinates. A repeated vertex counts once; a polyline that is one repeated point
/// is that point; one of fewer than two vertices is skipped
/// \param run progress, log, stop token and number of threads
/// \return for each such point one entry for each polyline and segment it lies on, sorted by line, segment and place;
/// neighbouring segments of one line meeting at their common vertex do not count (folding back on each other does).
/// Entries of the same point have the same `at`, bit for bit.
/// \throws BadInput when a coordinate is not finite
/// \throws Cancelled
///
/// Source: CGAL, exact predicates and constructions.
std::vector<Crossing> crossings(std::vector<std::vector<Vec2>> const& lines, Run const& run = {});

} // namespace thalweg::geometry
