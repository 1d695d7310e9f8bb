// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::geometry {

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
/// \param run progress, log, stop token and number of threads
/// \return one entry per pair of segments, sorted; the common vertex of consecutive segments does not count, unless
/// they fold back
/// \throws BadInput when a coordinate is not finite or there is not one pair of nodes per polyline
/// \throws Cancelled
///
/// Source: CGAL, exact predicates; rational arithmetic only where two segments cross inside both.
std::vector<Meeting> meetings(std::vector<std::vector<Vec2>> const& lines, std::vector<EndNodes> const& nodes,
                              Run const& run = {});

} // namespace thalweg::geometry
