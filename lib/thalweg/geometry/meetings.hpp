// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::geometry {

/// A segment of one polyline meets one of another, or of the same.
struct Meeting {
    std::size_t line = 0; ///< index of the polyline, the lesser of both
    std::size_t other = 0;
    std::size_t segment = 0;       ///< of line: between vertices segment and segment + 1
    std::size_t other_segment = 0; ///< of other; where that is line, the greater of both
    Vec2 at;                       ///< [m] the exact point, rounded once; of a shared stretch one end
    Vec2 until;                    ///< [m] the other end of a shared stretch; else at

    bool is_stretch() const { return at != until; }
    friend bool operator==(Meeting const&, Meeting const&) = default;
};

/// The numbers of the nodes in which a polyline begins and ends.
using EndNodes = std::array<std::size_t, 2>;

/// Where polylines of a network meet though they should not: everywhere but in their common nodes.
/// \pre polylines without repeated vertices; those of fewer than two are skipped.
/// \param lines the polylines
/// \param nodes by polyline
/// \param run progress, log, stop token and number of threads
/// \return one entry for each two segments that meet, exactly, sorted; not where both polylines end in the point and
/// have the same node there, nor where a segment goes on as the next (it counts that it folds back on itself).
/// \throws BadInput when a coordinate is not finite or nodes are not one pair a polyline
/// \throws Cancelled
///
/// Source: CGAL, exact predicates; rational arithmetic only where two segments cross inside both.
std::vector<Meeting> meetings(std::vector<std::vector<Vec2>> const& lines, std::vector<EndNodes> const& nodes,
                              Run const& run = {});

} // namespace thalweg::geometry
