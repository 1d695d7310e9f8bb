// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>

// Idea: Two questions in sequence: which segments may meet, and where do they. Pairs whose boxes
// overlap come from a grid of cells at least twice as wide as a mean box, or from streamed segment
// trees where boxes are too uneven for one grid. Whether a pair meets follows from the signs of
// determinants, which are exact (floating point where it suffices). Only where two segments cross
// inside both does rational arithmetic compute the point, which is rounded once: equal points then
// have equal bits, and can be keys.
// Source: CGAL; Zomorodian and Edelsbrunner 2000 for the segment trees.
// Cost: O(n + k) for n segments of similar length and k pairs of boxes; trees add logarithms.
// docs/performance.md: 0.3 us an arc for 1000 arcs, 0.3 % of the time of all pairs. One thread.
// Not for: nearness (segments_near in nearby.hpp, SegmentGrid): lines that miss each other by a
// rounding do not meet. Splitting at the points moves lines by an ulp, which may make new
// crossings: triangulate.hpp repeats.
// Example:
//     std::vector<Vec2> const one = {{0.0, 0.0}, {2.0, 2.0}};
//     std::vector<Vec2> const other = {{0.0, 2.0}, {2.0, 0.0}};
//     std::vector<Crossing> const all = crossings({one, other});
//     Vec2 const at = all.front().at; // (1, 1), the same in both entries

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
/// \return for each point one entry per polyline and segment through it, sorted by line, segment and position, with the
/// same `at` bit for bit; the common vertex of consecutive segments does not count, unless they fold back
/// \throws BadInput when a coordinate is not finite
///
/// Source: CGAL, exact predicates and constructions.
std::vector<Crossing> crossings(std::vector<std::vector<Vec2>> const& lines, Run const& run = {});

/// Two segments that meet, of one polyline or two.
struct Meeting {
    std::size_t line = 0; ///< index of the polyline, the lower of both
    std::size_t other = 0;
    std::size_t segment = 0;       ///< of line: between vertices segment and segment + 1
    std::size_t other_segment = 0; ///< of other; if that is line, the higher of both
    Vec2 at;                       ///< [m] the exact point, rounded once; of an overlap one end
    Vec2 until;                    ///< [m] the other end of an overlap; else `at`

    bool is_stretch() const { return at != until; }
    friend bool operator==(Meeting const&, Meeting const&) = default;
};

/// The numbers of the nodes at a polyline's ends.
using EndNodes = std::array<std::size_t, 2>;

/// Finds where polylines of a network meet away from their common nodes, exactly.
/// \param lines [m] without repeated vertices; those of fewer than two vertices are skipped
/// \param nodes by polyline
/// \return one entry per pair of segments, sorted; the common vertex of consecutive segments does not count, unless
/// they fold back
/// \throws BadInput when a coordinate is not finite or there is not one pair of nodes per polyline
///
/// Source: CGAL, exact predicates; rational arithmetic only where two segments cross inside both.
std::vector<Meeting> meetings(std::vector<std::vector<Vec2>> const& lines, std::vector<EndNodes> const& nodes,
                              Run const& run = {});

} // namespace thalweg::geometry
